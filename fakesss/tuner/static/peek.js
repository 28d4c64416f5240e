// Another picture in the place of the live one: for as long as a key or a button is held, or, after a short click, until
// the next one.
import { isTyping } from "./history.js";

const HELD_MS = 350; // from here on a press is a hold
const letters = document.getElementById("letter-keys"); // who speaks to a computer switches such keys off (WCAG 2.1.4)

// `found()` gives {settings, view, caption} or null; `key` is a letter or digit.
export class Peek {
  #isOn = false;
  #pressedAt = null;
  leave = new AbortController(); // forgets button and key

  constructor({ stage, say }, pictures, button, key, found) {
    Object.assign(this, { stage, say, pictures, button, found });
    button.setAttribute("aria-pressed", false);
    const until = { signal: this.leave.signal };
    button.addEventListener("pointerdown", (event) => event.button === 0 && this.#press(event), until);
    button.addEventListener("pointercancel", () => this.#end(), until);
    button.addEventListener("click", () => this.#click(), until);
    stage.addEventListener("live", () => this.#tell(false), until);
    this.#listen(key, until);
  }

  #listen(key, until) {
    const isMine = (event) => event.key?.toLowerCase() === key && !isTyping(event);
    const isPlain = (event) => !event.repeat && !event.ctrlKey && !event.metaKey && !event.altKey;
    const isBegun = (event) => letters.checked && isPlain(event) && isMine(event);
    addEventListener("keydown", (event) => isBegun(event) && this.#begin(), until);
    addEventListener("keyup", (event) => isMine(event) && this.#end(), until);
    addEventListener("blur", () => this.#end(), until);
  }

  #press({ pointerId }) {
    this.button.setPointerCapture(pointerId); // it may be let go elsewhere
    this.#pressedAt = this.#isOn ? null : performance.now();
    if (!this.#isOn) this.#begin();
  }

  // After a press by pointer, or alone by keyboard.
  #click() {
    const wasShort = this.#pressedAt !== null && performance.now() - this.#pressedAt < HELD_MS;
    const isNew = this.#pressedAt === null && !this.#isOn;
    this.#pressedAt = null;
    if (isNew) this.#begin();
    else if (!wasShort) this.#end();
  }

  async #begin() {
    const found = this.found();
    if (!found || this.button.disabled) return;
    this.#tell(true);
    try {
      const blob = await this.pictures.of(found.settings, found.view);
      if (this.#isOn) await this.stage.show(blob, found.caption);
    } catch (error) {
      this.#end();
      this.say("error", error.message);
    }
  }

  #end() {
    if (!this.#isOn) return;
    this.#tell(false);
    this.stage.showLive();
  }

  #tell(isOn) {
    this.#isOn = isOn;
    this.button.setAttribute("aria-pressed", isOn);
  }
}
