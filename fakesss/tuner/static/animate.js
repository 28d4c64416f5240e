// Auto-rotation about +y, and a light that wanders (thesis, section 5). Each is one step of undo from its start to its end.
import { picked } from "./lights.js";

const DEGREES = 20; // a second, of the light
const LONGEST_S = 0.25; // a page that was hidden or busy goes on where it was
const TURNING = "auto-rotation";
const WANDERING = "random light";

export function start(context) {
  return new Animation(context);
}

// A "change" event follows when one begins or ends, by whatever.
class Animation extends EventTarget {
  speed = 30; // of the rotation, degrees a second; negative: the other way
  #azimuth = { exact: 0, written: NaN };
  #path = null; // of the light: {from, to, angle, gone} and the angles {written} last
  #last = null; // time stamp of the frame before, while one goes on

  constructor({ settings }) {
    super();
    this.settings = settings;
    settings.addEventListener("change", () => this.#tell()); // undo ends gestures
  }

  get turning() {
    return this.settings.isGoingOn(TURNING);
  }

  get wandering() {
    return this.settings.isGoingOn(WANDERING);
  }

  turn(isOn) {
    return this.#run(TURNING, isOn);
  }

  wander(isOn) {
    return this.#run(WANDERING, isOn);
  }

  // Whatever goes on ends: something else is to be looked at.
  rest() {
    for (const gesture of [TURNING, WANDERING]) this.settings.settle(gesture);
  }

  // Who wants less motion is asked first.
  async #run(gesture, isOn) {
    if (isOn && (await isMotionWanted())) this.settings.begin(gesture);
    else this.settings.settle(gesture);
    this.#tell();
    if (this.#last === null && this.#isGoingOn) {
      this.#last = performance.now();
      requestAnimationFrame((at) => this.#tick(at));
    }
  }

  get #isGoingOn() {
    return this.turning || this.wandering;
  }

  #tick(at) {
    if (!this.#isGoingOn) {
      this.#last = null;
      return;
    }
    const seconds = Math.min(Math.max(at - this.#last, 0) / 1000, LONGEST_S); // by the clock, however slow pictures are
    this.#last = at;
    if (this.turning) this.#turn(seconds);
    if (this.wandering) this.#wander(seconds);
    requestAnimationFrame((next) => this.#tick(next));
  }

  // What is written is rounded; what is added up is not.
  #turn(seconds) {
    const now = this.settings.value("camera.azimuth");
    const from = now === this.#azimuth.written ? this.#azimuth.exact : now; // dragged meanwhile
    const exact = from + this.speed * seconds;
    const written = rounded(((((exact + 180) % 360) + 360) % 360) - 180);
    this.#azimuth = { exact: exact - 360 * Math.round((exact - written) / 360), written };
    this.settings.set("camera.azimuth", written, TURNING);
  }

  // Along a great circle to a direction that any is as likely to be as any other, then to the next.
  #wander(seconds) {
    const paths = [picked.path("light.azimuth"), picked.path("light.elevation")];
    const light = paths.map((path) => this.settings.value(path));
    if (!this.#path || this.#path.gone >= this.#path.angle || light.some((angle, i) => angle !== this.#path.written[i])) {
      const [from, to] = [vector(...light), anyDirection()];
      this.#path = { from, to, angle: Math.max(angleBetween(from, to), 1e-3), gone: 0 };
    }
    this.#path.gone += (DEGREES * seconds * Math.PI) / 180;
    this.#path.written = angles(between(this.#path)).map(rounded);
    this.settings.setMany(Object.fromEntries(paths.map((path, i) => [path, this.#path.written[i]])), WANDERING);
  }

  #tell() {
    this.dispatchEvent(new CustomEvent("change"));
  }
}

async function isMotionWanted() {
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) return true;
  const dialog = document.getElementById("calm");
  dialog.returnValue = ""; // what Escape leaves
  dialog.showModal();
  await new Promise((resolve) => dialog.addEventListener("close", resolve, { once: true }));
  return dialog.returnValue === "move";
}

// Degrees around +y from +z towards +x and above the horizon, as a unit vector, and back (fakesss/camera.py).
function vector(azimuth, elevation) {
  const [a, e] = [azimuth, elevation].map((degrees) => (degrees * Math.PI) / 180);
  return [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
}

function angles([x, y, z]) {
  return [Math.atan2(x, z), Math.asin(Math.min(Math.max(y, -1), 1))].map((radians) => (radians * 180) / Math.PI);
}

// Uniform over the sphere (Archimedes: so is its height).
function anyDirection() {
  return vector(360 * Math.random(), angles([0, 2 * Math.random() - 1, 0])[1]);
}

function angleBetween(one, two) {
  return Math.acos(Math.min(Math.max(one.reduce((sum, x, i) => sum + x * two[i], 0), -1), 1));
}

// The unit vector so far along the arc (Shoemake 1985, slerp).
function between({ from, to, angle, gone }) {
  const share = Math.min(gone / angle, 1);
  const [a, b] = [Math.sin((1 - share) * angle), Math.sin(share * angle)].map((x) => x / Math.sin(angle));
  const sum = from.map((x, i) => a * x + b * to[i]);
  const length = Math.hypot(...sum);
  return sum.map((x) => x / length);
}

function rounded(degrees) {
  return Number(degrees.toFixed(2));
}
