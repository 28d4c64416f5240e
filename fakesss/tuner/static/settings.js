// What differs from the scene that the tuner was started with, and its history. The only place where it changes.
//
// `changes` maps scene paths ("material.backlight", "light.azimuth", "object", "lights": a whole list) to values,
// `effects` names to "on" or "off". A "change" event follows every change; `event.detail.moving` is true while a gesture
// (a drag, a held key, an animation) goes on, and the gesture's end is a change of its own that is not.

const HISTORY = 200;

export class Settings extends EventTarget {
  #current = { changes: {}, effects: {} };
  #before = []; // what undo goes back to
  #after = [];
  #gesture = null; // its name while one goes on: it is one step of undo

  // `start` is what the server says at /start.json.
  constructor(start) {
    super();
    this.start = start;
  }

  get current() {
    return structuredClone(this.#current);
  }

  get canUndo() {
    return this.#before.length > 0;
  }

  get canRedo() {
    return this.#after.length > 0;
  }

  get isMoving() {
    return this.#gesture !== null;
  }

  // What undo would go back to: the B of A/B. Null at the start.
  get previous() {
    return this.#before.length ? structuredClone(this.#before.at(-1)) : null;
  }

  // The value of a scene path now; `null` is a field left empty.
  value(path) {
    if (path in this.#current.changes) return structuredClone(this.#current.changes[path]);
    return this.original(path);
  }

  // The value in the scene that the tuner was started with.
  original(path) {
    return structuredClone(path.split(".").reduce((place, part) => place?.[part], this.start.base));
  }

  isChanged(path) {
    return path in this.#current.changes;
  }

  effect(name) {
    return this.#current.effects[name] ?? "auto";
  }

  // Set one path. Within a gesture (`gesture` any word) steps are one for undo, until `settle()`.
  set(path, value, gesture = null) {
    this.setMany({ [path]: value }, gesture);
  }

  setMany(values, gesture = null) {
    this.#change(gesture, (next) => {
      for (const [path, value] of Object.entries(values)) {
        if (isSame(value, this.original(path))) delete next.changes[path];
        else next.changes[path] = structuredClone(value);
      }
    });
  }

  setEffect(name, state) {
    this.#change(null, (next) => {
      if (state === "auto") delete next.effects[name];
      else next.effects[name] = state;
    });
  }

  // Back to the value at the start: one path, several, or without any all.
  reset(...paths) {
    this.#change(null, (next) => {
      if (!paths.length) Object.assign(next, { changes: {}, effects: {} });
      for (const path of paths) delete next.changes[path];
    });
  }

  // All of them at once, as a link, a pin or a cell of a sweep has them.
  replace(settings) {
    this.#change(null, (next) => Object.assign(next, structuredClone(settings)));
  }

  // A gesture ends: the picture may become as it will be.
  settle() {
    if (this.#gesture === null) return;
    this.#gesture = null;
    this.#tell(false);
  }

  undo() {
    this.#step(this.#before, this.#after);
  }

  redo() {
    this.#step(this.#after, this.#before);
  }

  #change(gesture, change) {
    const next = this.current;
    change(next);
    if (isSame(next, this.#current)) return;
    if (gesture === null || gesture !== this.#gesture) {
      this.#before.push(this.#current);
      if (this.#before.length > HISTORY) this.#before.shift();
    }
    this.#after.length = 0;
    this.#gesture = gesture;
    this.#current = next;
    this.#tell(gesture !== null);
  }

  #step(from, to) {
    if (!from.length) return;
    this.#gesture = null;
    to.push(this.#current);
    this.#current = from.pop();
    this.#tell(false);
  }

  #tell(moving) {
    this.dispatchEvent(new CustomEvent("change", { detail: { moving } }));
  }
}

// Whether two JSON values are the same, whatever the order of keys.
export function isSame(one, other) {
  if (typeof one !== "object" || typeof other !== "object" || one === null || other === null) return one === other;
  const keys = Object.keys(one);
  return (
    Array.isArray(one) === Array.isArray(other) &&
    keys.length === Object.keys(other).length &&
    keys.every((key) => key in other && isSame(one[key], other[key]))
  );
}

// The settings as a link's fragment, and back; null for one that holds none.
export function asFragment(settings) {
  return `#s=${encodeURIComponent(JSON.stringify(settings))}`;
}

export function fromFragment(fragment) {
  if (!fragment.startsWith("#s=")) return null;
  const { changes, effects } = JSON.parse(decodeURIComponent(fragment.slice(3)));
  return { changes: { ...changes }, effects: { ...effects } };
}
