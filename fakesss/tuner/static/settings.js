// What differs from the scene that the tuner was started with, and its history. The only place where it changes.
//
// `changes` maps scene paths ("material.backlight", "light.azimuth", "object", "lights": a whole list) to values,
// `effects` names to "on" or "off". A "change" event follows every change; `event.detail.moving` is true while a gesture
// (a drag, a held key, an animation) goes on, and the gesture's end is a change of its own that is not; `byHand` is false
// for an animation's changes.

const HISTORY = 200;

export class Settings extends EventTarget {
  #current = { changes: {}, effects: {} };
  #before = []; // what undo goes back to
  #after = [];
  #origins = new WeakMap(); // of such settings, if a further light was removed: the places of the others at the start
  #gestures = new Map(); // those that go on: name -> {lasts, isStep: whether undo has its step}

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
    return this.#gestures.size > 0;
  }

  // What undo would go back to: the B of A/B. Null at the start.
  get previous() {
    return this.#before.length ? structuredClone(this.#before.at(-1)) : null;
  }

  // The value of a scene path now ("lights.0.azimuth" too); `null` is a field left empty.
  value(path) {
    return this.valueIn(this.#current, path);
  }

  // The same in other settings: those of a pin, say.
  valueIn({ changes }, path) {
    const [field, within] = parts(path);
    return structuredClone(walk(field in changes ? changes[field] : this.#untouched(changes, field), within));
  }

  // The value in the scene that the tuner was started with, there of the light that the path means now; undefined for
  // one that was not there.
  original(path) {
    const [field, within] = parts(path);
    const whole = within.length ? this.#places.map((place) => this.start.base[field][place]) : this.start.base;
    return structuredClone(walk(whole, within.length ? within : field.split(".")));
  }

  isChanged(path) {
    const [field, within] = parts(path);
    return !isSame(this.value(path), within.length ? this.original(path) : this.#untouched(this.#current.changes, field));
  }

  // The quality that the field has its value from, which nobody set; "" if it has it from the scene.
  filledBy(path) {
    const { changes } = this.#current;
    const quality = changes.quality === undefined ? this.start.base.quality : changes.quality;
    return quality && !(path in changes) && this.#filled(changes, path, quality) ? quality : "";
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
      for (const [path, value] of Object.entries(values)) this.#put(next, path, value);
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
      for (const path of paths) {
        if (parts(path)[1].length) this.#put(next, path, this.original(path));
        else delete next.changes[path];
      }
    });
  }

  // The others stay what they were at the start, each in its new place.
  removeLight(index) {
    this.#change(null, (next) => {
      this.#origins.set(next, this.#places.toSpliced(index, 1));
      this.#put(next, "lights", this.valueIn(next, "lights").toSpliced(index, 1));
    });
  }

  // All of them at once, as a link, a pin or a cell of a sweep has them.
  replace(settings) {
    this.#change(null, (next) => {
      Object.assign(next, structuredClone(settings));
      if (!isSame(this.valueIn(next, "lights"), this.value("lights"))) this.#origins.delete(next);
    });
  }

  // A gesture that goes on beside all others (an animation) until it is settled by name; undo ends it too.
  begin(gesture) {
    this.#gestures.set(gesture, { lasts: true, isStep: false });
  }

  isGoingOn(gesture) {
    return this.#gestures.has(gesture);
  }

  // A gesture ends, without a name whichever does not last: the picture may become as it will be.
  settle(gesture = null) {
    const before = this.#gestures.size;
    if (gesture === null) this.#endPassing();
    else this.#gestures.delete(gesture);
    if (this.#gestures.size < before) this.#tell();
  }

  // The last step of undo, only to be handed to `join`.
  get mark() {
    return this.#before.at(-1);
  }

  // What `act` changes is one step with all those since `mark`, and none if nothing comes of them.
  join(mark, act) {
    act();
    const first = this.#before.indexOf(mark) + 1;
    if (this.#before.length === first || (mark && !first)) return;
    this.#before.length = first + 1;
    if (isSame(this.#before[first], this.#current)) this.#before.pop();
    this.#tell();
  }

  undo() {
    this.#step(this.#before, this.#after);
  }

  redo() {
    this.#step(this.#after, this.#before);
  }

  // That the further lights had at the start. Which ones are missing from a list that came from elsewhere nobody knows.
  get #places() {
    const { lights } = this.start.base;
    const isShort = this.value("lights").length < lights.length;
    return this.#origins.get(this.#current) ?? (isShort ? [] : [...lights.keys()]);
  }

  #put(next, path, value) {
    const [field, within] = parts(path);
    if (within.length) {
      const whole = this.valueIn(next, field);
      walk(whole, within.slice(0, -1))[within.at(-1)] = value;
      this.#put(next, field, whole);
    } else if (isSame(value, this.#untouched(next.changes, field))) delete next.changes[field];
    else next.changes[field] = structuredClone(value);
  }

  // What a field is that was left alone: as the quality fills it that is asked for, or as it was at the start.
  #untouched(changes, field) {
    const quality = changes.quality === undefined ? this.start.base.quality : changes.quality;
    const knob = this.#filled(changes, field, quality) ?? this.#filled({}, field, null);
    return knob && field !== "quality" ? knob[field] : this.original(field);
  }

  // The fields that a quality fills together with this one; not if another of them was set.
  #filled(changes, field, quality) {
    const isFilled = (knob) => field in knob && Object.keys(knob).every((path) => path === field || !(path in changes));
    return this.start.qualities[quality ?? ""]?.find(isFilled);
  }

  #change(gesture, change) {
    const next = this.current;
    this.#origins.set(next, this.#origins.get(this.#current));
    change(next);
    if (!("lights" in next.changes)) this.#origins.delete(next);
    if (isSame(next, this.#current)) return;
    if (!this.#gestures.has(gesture)) this.#endPassing();
    if (gesture !== null && !this.#gestures.has(gesture)) this.#gestures.set(gesture, { lasts: false, isStep: false });
    const going = this.#gestures.get(gesture);
    if (!going?.isStep) {
      this.#before.push(this.#current);
      if (this.#before.length > HISTORY) this.#before.shift();
      if (going) going.isStep = true;
    }
    this.#after.length = 0;
    this.#current = next;
    this.#tell(!going?.lasts);
  }

  #endPassing() {
    for (const [name, { lasts }] of this.#gestures) if (!lasts) this.#gestures.delete(name);
  }

  #step(from, to) {
    if (!from.length) return;
    this.#gestures.clear();
    to.push(this.#current);
    this.#current = from.pop();
    this.#tell();
  }

  #tell(byHand = true) {
    this.dispatchEvent(new CustomEvent("change", { detail: { moving: this.isMoving, byHand } }));
  }
}

// The field that a path changes, and where in it: further lights change as a whole list.
function parts(path) {
  const [first, ...rest] = path.split(".");
  return first === "lights" ? [first, rest] : [path, []];
}

function walk(place, within) {
  return within.reduce((value, part) => value?.[part], place);
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

// The settings as a link's fragment, with what is looked at if it is not the picture, and back; null for one that holds none.
export function asFragment(settings, view) {
  return `#s=${encodeURIComponent(JSON.stringify(view === "picture" ? settings : { ...settings, view }))}`;
}

export function fromFragment(fragment) {
  if (!fragment.startsWith("#s=")) return null;
  const { changes, effects, view } = JSON.parse(decodeURIComponent(fragment.slice(3)));
  return { settings: { changes: { ...changes }, effects: { ...effects } }, view };
}
