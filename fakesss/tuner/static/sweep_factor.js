// One setting that varies: which, and its levels. "change" follows whatever changes them.
import { drawn } from "./sweep_cells.js";
import { around, MOST_LEVELS, parsed, shown, spaced, variables } from "./sweep_levels.js";

export class FactorForm extends EventTarget {
  #variable = null; // of `variables`; null: nothing varies here
  #levels = [];

  // `isOptional`: it may be left out.
  constructor(element, settings, isOptional) {
    super();
    Object.assign(this, { element, settings, isOptional });
    for (const name of ["path", "numbers", "from", "to", "count", "spacing", "levels", "choices", "now", "add", "problem"]) {
      this[name] = element.querySelector(`.${name}`);
    }
    this.path.addEventListener("change", () => this.#choose());
    for (const input of [this.from, this.to, this.count, this.spacing]) input.addEventListener("change", () => this.#space());
    this.count.addEventListener("input", () => this.count.value && this.#space());
    this.levels.addEventListener("change", () => this.#take(parsed(this.levels.value, this.#variable.scale)));
    this.choices.addEventListener("change", () => this.#take(this.#chosen()));
    this.add.addEventListener("click", () => this.#addNow());
    this.#offer();
  }

  // As a study has it, and `labels` of the levels; null where nothing varies or the levels cannot be read.
  get factor() {
    if (!this.#variable || !this.#levels.length) return null;
    const { name, path } = this.#variable;
    return { name, path, levels: this.#levels, labels: this.#levels.map((level) => this.#label(level)) };
  }

  // Something varies, but at levels that cannot be read.
  get isBroken() {
    return this.#variable !== null && !this.#levels.length;
  }

  // The settings have changed: there may be other lights, and another value is the one now.
  showSettings() {
    const isGone = this.#offer();
    if (isGone) this.#choose();
    this.#showNow();
  }

  // The select's options; whether the one that was chosen is gone.
  #offer() {
    const lights = this.settings.value("lights").length;
    if (lights === this.lights) return false;
    this.lights = lights;
    const found = variables(this.settings);
    this.variables = new Map(found.map((each) => [each.path, each]));
    const chosen = this.path.value;
    const groups = Map.groupBy(found, ({ group }) => group);
    const options = [...groups].map(([label, members]) => {
      const group = Object.assign(document.createElement("optgroup"), { label });
      group.append(...members.map(({ path, name }) => new Option(name, path)));
      return group;
    });
    this.path.replaceChildren(new Option(this.isOptional ? "nothing else" : "choose a setting", ""), ...options);
    this.path.value = this.variables.has(chosen) ? chosen : "";
    return this.path.value !== chosen;
  }

  #choose() {
    this.#variable = this.variables.get(this.path.value) ?? null;
    const { scale, choices, path } = this.#variable ?? {};
    this.numbers.hidden = !scale;
    this.choices.hidden = !choices;
    if (scale) {
      const now = this.settings.value(path);
      [this.from.value, this.to.value] = around(now, scale);
      this.spacing.value = scale.isLog && this.from.value > 0 ? "ratios" : "equal";
      this.#space();
    } else if (choices) {
      this.choices.replaceChildren(...choices.map(({ value, text }) => box(JSON.stringify(value), text)));
      this.#take(this.#chosen());
    } else this.#take({ levels: [] });
  }

  #space() {
    const { scale } = this.#variable;
    const [from, to] = [this.from, this.to].map((input) => {
      const { value, problem } = scale.read(input.value);
      mark(input, problem);
      return { value, problem };
    });
    const count = Math.min(Math.max(Math.round(this.count.valueAsNumber) || 2, 2), MOST_LEVELS);
    if (this.count.value !== "") this.count.value = count;
    const isRatios = this.spacing.value === "ratios";
    const problem = from.problem ?? to.problem ?? (isRatios && !(from.value > 0 && to.value > 0) && "Equal ratios need numbers above 0.");
    if (problem) return this.#take({ problem });
    const levels = spaced(from.value, to.value, count, isRatios, scale);
    this.levels.value = levels.join(", ");
    if (this.count.value !== "") this.count.value = levels.length; // there may be fewer whole numbers
    this.#take({ levels });
  }

  #chosen() {
    const levels = [...this.choices.querySelectorAll("input:checked")].map(({ value }) => JSON.parse(value));
    return levels.length ? { levels } : { problem: "Tick at least one level." };
  }

  #take({ levels = [], problem = "" }) {
    this.#levels = levels;
    mark(this.levels, problem);
    this.problem.textContent = problem;
    this.problem.hidden = !problem;
    this.#showNow();
    this.dispatchEvent(new Event("change"));
  }

  #showNow() {
    const now = this.#variable && drawn(this.settings, this.#variable.path);
    const isAmong = this.#levels.includes(now);
    this.now.hidden = !this.#variable;
    if (!this.#variable) return;
    const is = now === null ? "left empty" : this.#label(now);
    this.now.querySelector("span").textContent = `Now ${is}${isAmong || now === null ? "." : ", which is none of them."}`;
    this.add.hidden = isAmong || now === null || !this.#variable.scale;
  }

  #addNow() {
    const now = drawn(this.settings, this.#variable.path);
    const levels = [...this.#levels, now].sort((one, other) => one - other);
    this.levels.value = levels.join(", ");
    this.levels.focus(); // the button vanishes
    this.#take(parsed(this.levels.value, this.#variable.scale));
  }

  #label(level) {
    return this.#variable.choices?.find(({ value }) => value === level)?.text ?? shown(level, this.#levels);
  }
}

function box(value, text) {
  const label = document.createElement("label");
  label.append(Object.assign(document.createElement("input"), { type: "checkbox", value, checked: true }), ` ${text}`);
  return label;
}

function mark(input, problem) {
  if (problem) input.setAttribute("aria-invalid", "true");
  else input.removeAttribute("aria-invalid");
}
