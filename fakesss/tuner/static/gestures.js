// Turning, lighting and zooming with the hand on the picture: mouse, pen, fingers, wheel and keys.
//
// Every gesture is one step of undo, from the first touch to the last. Angles go by the picture: a drag across its
// shorter side is half a turn.
import { picked } from "./lights.js";
import { wrapped } from "./numbers.js";

const SLOP_PX = 6; // a finger trembles by less
const PAUSE_MS = 250; // after which the next turn of the wheel, or tap on a key, is another gesture
const SMALLEST_PX = 100; // of a picture, and of what stands there before the first
const KEY_DEGREES = 5;
const KEY_ZOOM = 1.05;
const NEAREST = 0.1; // sphere radii
const FARTHEST = 1e3;
const BUTTONS = { 0: "turn", 1: "lens", 2: "light" };
export const HOME = ["camera.azimuth", "camera.elevation", "camera.distance", "camera.field_of_view"];

const KEYS = {
  ArrowLeft: [-KEY_DEGREES, 0],
  ArrowRight: [KEY_DEGREES, 0],
  ArrowUp: [0, KEY_DEGREES],
  ArrowDown: [0, -KEY_DEGREES],
};
const ZOOMS = { "+": 1 / KEY_ZOOM, "=": 1 / KEY_ZOOM, "-": KEY_ZOOM };

export function start({ settings, stage }) {
  const moves = new Moves(settings, stage);
  const fingers = new Pointers(moves);
  const { place } = stage;
  place.addEventListener("pointerdown", (event) => fingers.down(event));
  place.addEventListener("pointermove", (event) => fingers.move(event));
  for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) {
    place.addEventListener(kind, (event) => fingers.up(event));
  }
  place.addEventListener("mousedown", (event) => event.button === 1 && event.preventDefault()); // no scrolling by itself
  addEventListener("contextmenu", (event) => {
    if (fingers.isLighting || place.contains(event.target)) event.preventDefault();
  });
  place.addEventListener("dblclick", () => settings.reset(...HOME));
  wheel(place, moves);
  keys(place, moves, settings);
}

// What a hand can do, in degrees and factors.
class Moves {
  constructor(settings, stage) {
    Object.assign(this, { settings, stage });
  }

  // That a drag of one CSS pixel is.
  get degrees() {
    const { width, height } = this.stage.canvas.getBoundingClientRect();
    return 180 / Math.max(Math.min(width, height), SMALLEST_PX);
  }

  // The object turns to the right and upwards, as if its front was dragged: the camera goes the other way.
  turn(right, up) {
    const azimuth = wrapped(this.settings.value("camera.azimuth") - right);
    const elevation = upright(this.settings.value("camera.elevation") - up);
    this.settings.setMany({ "camera.azimuth": azimuth, "camera.elevation": elevation }, "turn");
  }

  light(right, up) {
    const azimuth = wrapped(this.settings.value(picked.path("light.azimuth")) + right);
    const elevation = upright(this.settings.value(picked.path("light.elevation")) + up);
    this.settings.setMany({ [picked.path("light.azimuth")]: azimuth, [picked.path("light.elevation")]: elevation }, "light");
  }

  zoom(factor) {
    const half = (this.settings.value("camera.field_of_view") * Math.PI) / 360;
    const distance = this.settings.value("camera.distance") ?? 1 / Math.sin(half); // that from which the sphere just fits
    const next = Math.min(Math.max(distance * factor, NEAREST), FARTHEST);
    this.settings.set("camera.distance", Number(next.toPrecision(4)), "zoom");
  }

  lens(up) {
    const angle = this.settings.value("camera.field_of_view") * Math.exp(-up / 200);
    this.settings.set("camera.field_of_view", Number(Math.min(Math.max(angle, 1), 170).toFixed(2)), "lens");
  }
}

// One mouse or pen, one finger or two.
class Pointers {
  #at = new Map(); // pointer id -> {x, y}, CSS pixels
  #kind = null; // what they do; "wait": not yet clear; "done": until all are gone
  #from = null; // where two fingers, or a finger that may yet tremble, began
  isLighting = false; // also for the menu that comes after the button is up

  constructor(moves) {
    this.moves = moves;
  }

  down(event) {
    if (this.#at.size === 2 || (event.pointerType === "mouse" && this.#at.size)) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    this.#at.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (this.#at.size === 2) this.moves.settings.settle();
    const isFinger = event.pointerType === "touch";
    const shifted = event.shiftKey || event.ctrlKey; // a Mac's Ctrl-click is a right click
    this.#kind = isFinger ? "wait" : shifted && event.button === 0 ? "light" : (BUTTONS[event.button] ?? "done");
    this.isLighting = this.#kind === "light";
    this.#from = this.#pose();
  }

  move(event) {
    const before = this.#at.get(event.pointerId);
    if (!before || this.#kind === "done") return;
    const earlier = this.#pose();
    this.#at.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const now = this.#pose();
    if (this.#kind === "wait") this.#kind = this.#meant(now);
    this.#act(now.x - earlier.x, earlier.y - now.y, earlier.spread / now.spread);
  }

  up(event) {
    if (!this.#at.delete(event.pointerId)) return;
    this.moves.settings.settle();
    this.#kind = this.#at.size ? "done" : null;
  }

  #act(right, up, closer) {
    const { degrees } = this.moves;
    if (this.#kind === "turn") this.moves.turn(right * degrees, up * degrees);
    if (this.#kind === "light") this.moves.light(right * degrees, up * degrees);
    if (this.#kind === "lens") this.moves.lens(up);
    if (this.#kind === "pinch" && Number.isFinite(closer)) this.moves.zoom(closer);
  }

  // The middle of what touches, and how far two fingers are apart.
  #pose() {
    const [one, two = one] = this.#at.values();
    return { x: (one.x + two.x) / 2, y: (one.y + two.y) / 2, spread: Math.hypot(one.x - two.x, one.y - two.y) };
  }

  // What fingers do, once they have done enough of it.
  #meant(now) {
    const moved = Math.hypot(now.x - this.#from.x, now.y - this.#from.y);
    const spread = Math.abs(now.spread - this.#from.spread);
    if (Math.max(moved, spread) < SLOP_PX) return "wait";
    if (this.#at.size === 1) return "turn";
    return spread > moved ? "pinch" : "light";
  }
}

function wheel(place, moves) {
  let pause = null;
  place.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * [1, 16, 400][event.deltaMode]; // pixels, lines, pages
      moves.zoom(Math.exp(pixels * (event.ctrlKey ? 0.01 : 0.001))); // a touchpad's pinch comes as a small Ctrl-wheel
      clearTimeout(pause);
      pause = setTimeout(() => moves.settings.settle(), PAUSE_MS);
    },
    { passive: false },
  );
}

// While the picture has the focus. Keys held together are one gesture, and so are taps in quick succession: a picture as
// it will be, drawn between two of them, would keep the second waiting.
function keys(place, moves, settings) {
  const held = new Set();
  let pause = null;
  const act = ({ key, shiftKey }) => {
    if (key in KEYS) shiftKey ? moves.light(...KEYS[key]) : moves.turn(...KEYS[key]);
    else if (key in ZOOMS) moves.zoom(ZOOMS[key]);
    else if (key === "0") settings.reset(...HOME);
    else return false;
    return true;
  };
  const release = () => {
    held.clear();
    settings.settle();
    document.getElementById("spoken").textContent = inWords(settings);
  };
  place.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !act(event)) return;
    event.preventDefault();
    clearTimeout(pause);
    held.add(event.code);
  });
  place.addEventListener("keyup", ({ code }) => {
    if (held.delete(code) && !held.size) pause = setTimeout(release, PAUSE_MS);
  });
  place.addEventListener("blur", () => held.size && release());
}

function inWords(settings) {
  const of = (path) => Math.round(settings.value(path));
  return (
    `Camera ${of("camera.azimuth")}° around, ${of("camera.elevation")}° up; ` +
    `light ${of(picked.path("light.azimuth"))}° around, ${of(picked.path("light.elevation"))}° up.`
  );
}

function upright(degrees) {
  return Number(Math.min(Math.max(degrees, -90), 90).toFixed(2));
}
