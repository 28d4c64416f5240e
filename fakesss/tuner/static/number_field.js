// A slider and the number beside it. Keys and drags are gestures: each is one step of undo.
import { slide } from "./finger.js";
import { written } from "./numbers.js";

const TEN = 10; // steps, with Shift or Page Up

const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: TEN, PageDown: -TEN };

export class NumberField {
  #value = 0;
  #isStepping = false; // a key is held
  #isTyping = false; // the text is not what `show` put there

  // `hands`: change(value, isGesture), settle(), tell(problem) for what was typed wrong; empty() if it may be left empty.
  constructor(element, scale, hands) {
    this.slider = element.querySelector("input[type=range]");
    this.typed = element.querySelector("input.typed");
    this.scale = scale;
    this.hands = hands;
    if (this.slider) {
      const take = (place) => hands.change(scale.at(place), true);
      const leave = () => (this.slider.value = scale.place(this.#value));
      slide(this.slider, { take, leave, settle: hands.settle });
    }
    this.typed.addEventListener("input", () => (this.#isTyping = true));
    this.typed.addEventListener("change", () => this.#read());
    for (const input of [this.slider, this.typed].filter(Boolean)) {
      input.addEventListener("keydown", (event) => this.#press(event));
      input.addEventListener("keyup", ({ key }) => key !== "Shift" && this.#release());
      input.addEventListener("blur", () => this.#release());
    }
  }

  // `unit` is read out after the number.
  show(value, unit) {
    this.#value = value;
    if (this.slider) {
      this.slider.value = this.scale.place(value);
      this.slider.style.setProperty("--at", `${this.scale.place(value) / 10}%`); // the track's bright part
      this.slider.setAttribute("aria-valuetext", `${written(value)} ${unit}`.trim());
    }
    if (!this.#isTyping) this.typed.value = written(value);
  }

  // What was typed and not taken.
  forget() {
    if (!this.#isTyping) return;
    this.#isTyping = false;
    this.typed.value = written(this.#value);
    this.#say();
    this.typed.dispatchEvent(new Event("taken", { bubbles: true })); // undo is the page's again
  }

  #press(event) {
    if (event.key === "Enter") this.#read();
    if (event.key === "Escape" && this.#isTyping) this.forget();
    const isSlider = event.target === this.slider;
    if (!isSlider && /Up|Down/.test(event.key)) this.#read(); // steps go on from what was typed
    const to = this.#to(event, isSlider);
    if (to === null || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (isSlider) this.forget();
    if (this.#isTyping) return; // what is wrong stays to be mended
    this.#isStepping = true;
    this.#value = to; // a held key may repeat before this is shown
    this.hands.change(to, true);
  }

  // The value that a key leads to; null for one that the browser is left. In text, left and right move the cursor.
  #to({ key, shiftKey }, isSlider) {
    const { low, high } = this.scale;
    if (isSlider && key === "Home") return low;
    if (isSlider && key === "End") return high;
    if (!(key in STEPS) || (!isSlider && /Left|Right/.test(key))) return null;
    const to = this.scale.stepped(this.#value, STEPS[key] * (shiftKey && key.startsWith("Arrow") ? TEN : 1));
    return isSlider && this.#value >= low && this.#value <= high ? Math.min(Math.max(to, low), high) : to;
  }

  #release() {
    if (this.#isStepping) this.hands.settle();
    this.#isStepping = false;
  }

  #read() {
    if (!this.#isTyping) return;
    if (this.hands.empty && !this.typed.value.trim()) {
      this.forget();
      this.hands.empty();
      return;
    }
    const { value, problem } = this.scale.read(this.typed.value);
    this.#say(problem);
    if (problem) return;
    this.forget();
    this.#value = value;
    this.hands.change(value, false);
  }

  #say(problem = "") {
    this.typed.setAttribute("aria-invalid", Boolean(problem));
    this.hands.tell(problem);
  }
}
