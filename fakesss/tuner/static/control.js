// One field of the scene on the panel. What it is stands in its element's data; see fakesss/tuner/controls.py.
import { fromHex, toHex } from "./colour.js";
import { fitted } from "./fitted.js";
import { picked } from "./lights.js";
import { NumberField } from "./number_field.js";
import { Scale } from "./numbers.js";
import { isSame } from "./settings.js";

const SWITCHES = { "blur.enabled": "blur", "occlusion.enabled": "occlusion" }; // fields that effects switch

// Kinds differ in `build`, and in `write`, which shows a value.
class Control {
  constructor(element, settings) {
    Object.assign(this, { element, settings, data: element.dataset });
    this.unit = element.querySelector(".unit")?.textContent ?? "";
    this.needs = JSON.parse(this.data.needs ?? "[]");
    this.inputs = [...element.querySelectorAll("input, select")];
    this.section = element.closest("[role=tabpanel]");
    for (const part of ["problem", "reset", "given", "otherwise", "tip"]) this[`${part}Part`] = element.querySelector(`.${part}`);
    this.tip = this.tipPart.textContent;
    this.build();
    this.resetPart.addEventListener("click", () => this.reset());
    this.marks = []; // when the pointer came down the last two times: the clicks of a double-click are no steps of their own
    element.addEventListener("pointerdown", () => (this.marks = [this.marks[1], settings.mark]));
    for (const target of element.querySelectorAll(".label, input[type=range]")) {
      target.addEventListener("dblclick", () => settings.join(this.marks[0], () => this.reset()));
    }
  }

  // Of the light that is picked.
  get path() {
    return picked.path(this.data.path);
  }

  get value() {
    return this.settings.value(this.path);
  }

  // Of a light that was not there at the start.
  get isAdded() {
    return this.settings.original(this.path) === undefined;
  }

  set(value, isGesture = false) {
    this.tell("");
    this.settings.set(this.path, value, isGesture ? `control ${this.path}` : null);
  }

  reset() {
    this.forget();
    if (this.isAdded) this.settings.set(this.path, JSON.parse(this.data.default));
    else this.settings.reset(this.path);
    if (document.activeElement === this.resetPart) this.inputs[0].focus(); // it is about to vanish
  }

  forget() {
    this.tell("");
    for (const field of this.fields ?? []) field.forget();
  }

  tell(problem) {
    this.problemPart.textContent = problem;
    this.problemPart.hidden = !problem;
  }

  // Nothing is done for what nobody sees: a drag has no time for it.
  show(faces) {
    if (this.section.hidden) return;
    const value = this.value;
    const isEmpty = value === null && this.auto;
    this.write(isEmpty ? fitted(this.path, (path) => this.settings.value(path), faces) : value);
    if (this.auto) this.auto.checked = value === null;
    this.element.classList.toggle("fitted", Boolean(isEmpty));
    this.mark();
    this.disable(this.overridden || this.lacking);
  }

  // By the effect that sets this field: on numbers only "off" does, for "on" has none to set.
  get overridden() {
    const state = this.data.effect ? this.settings.effect(this.data.effect) : "auto";
    return state === "off" || (state === "on" && this.data.kind === "switch") ? `${state} by hand, under Effects` : "";
  }

  get lacking() {
    const isUnmet = ([path, values]) => !values.includes(this.settings.value(picked.path(path)));
    const switchedOff = ([path]) => this.settings.effect(SWITCHES[path]) === "off";
    return this.needs.find((need) => isUnmet(need) || switchedOff(need))?.[2] ?? "";
  }

  mark() {
    const isChanged = this.isAdded ? !isSame(this.value, JSON.parse(this.data.default)) : this.settings.isChanged(this.path);
    this.element.classList.toggle("changed", isChanged);
    this.resetPart.hidden = !isChanged;
    this.givenPart.textContent = this.settings.filledBy(this.path);
    this.tipPart.textContent = this.tip.replace(this.data.path, this.path);
  }

  disable(why) {
    this.otherwisePart.textContent = why;
    this.element.classList.toggle("idle", Boolean(why));
    if (why) this.forget();
    for (const input of this.inputs) input.disabled = Boolean(why);
  }
}

class NumberControl extends Control {
  build() {
    const hands = {
      change: (value, isGesture) => this.set(value, isGesture),
      settle: () => this.settings.settle(),
      tell: (problem) => this.tell(problem),
      empty: this.data.empty === undefined ? null : () => this.set(null),
    };
    this.fields = [new NumberField(this.element, new Scale(this.data), hands)];
    this.auto = this.element.querySelector(".auto input");
    this.auto?.addEventListener("change", () => this.set(this.auto.checked ? null : this.shown));
  }

  write(value) {
    this.shown = value;
    this.fields[0].show(value, this.unit);
  }
}

// Several numbers that are one field: a colour, attenuation factors, a size.
class PartsControl extends Control {
  build() {
    this.fields = [...this.element.querySelectorAll(".part")].map((part, index) => {
      const label = `${this.data.label}, ${part.dataset.part}`;
      return new NumberField(part, new Scale({ ...this.data, label }), {
        change: (value, isGesture) => this.set(this.value.with(index, value), isGesture),
        settle: () => this.settings.settle(),
        tell: (problem) => this.tell(problem),
      });
    });
  }

  write(values) {
    for (const [index, field] of this.fields.entries()) field.show(values[index], this.unit);
  }
}

class ColourControl extends PartsControl {
  build() {
    super.build();
    this.swatch = this.element.querySelector("input[type=color]");
    this.swatch.addEventListener("input", () => this.set(fromHex(this.swatch.value, Math.max(...this.value, 1)), true));
    this.swatch.addEventListener("change", () => this.settings.settle());
  }

  write(values) {
    super.write(values);
    this.swatch.value = toHex(values);
  }
}

class ChoiceControl extends Control {
  build() {
    this.select = this.element.querySelector("select");
    this.select.addEventListener("change", () => this.set(JSON.parse(this.select.value)));
  }

  write(value) {
    this.select.value = JSON.stringify(value);
  }
}

class SwitchControl extends Control {
  build() {
    this.box = this.element.querySelector("input");
    this.box.addEventListener("change", () => this.set(this.box.checked));
  }

  write(value) {
    this.box.checked = value;
  }
}

export const KINDS = {
  number: NumberControl,
  colour: ColourControl,
  triple: PartsControl,
  size: PartsControl,
  choice: ChoiceControl,
  switch: SwitchControl,
};
