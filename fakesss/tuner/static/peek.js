// Another picture in the place of the live one: for as long as a key or a button is held, or, after a short click, until
// the next one.
import { isTyping } from "./history.js";

const HELD_MS = 350; // from here on a press is a hold
const letters = document.getElementById("letter-keys"); // who speaks to a computer switches such keys off (WCAG 2.1.4)

// `found()` gives {settings, view, caption} or null; `key` is a letter or digit.
export class Peek {
  #isOn = false;
  #presses = 0; // pictures may come after the press that asked for them
  #pressedAt = null;
  #held = null; // the code of its key while that is down
  leave = new AbortController(); // forgets button and key

  constructor({ settings, stage, animation, say }, pictures, button, key, found) {
    Object.assign(this, { stage, animation, say, pictures, button, found });
    button.setAttribute("aria-pressed", false);
    const until = { signal: this.leave.signal };
    button.addEventListener("pointerdown", (event) => event.button === 0 && this.#press(event), until);
    button.addEventListener("pointercancel", () => this.#end(), until);
    button.addEventListener("click", () => this.#click(), until);
    const over = () => this.#isOn && this.#tell(false);
    for (const event of ["live", "view"]) stage.addEventListener(event, over, until);
    settings.addEventListener("change", over, until); // also while its picture is still being drawn
    this.#listen(key, until);
  }

  // The key is let go wherever the focus went meanwhile; with Shift let go before it, it is another letter.
  #listen(key, until) {
    const isPlain = (event) => !event.repeat && !event.ctrlKey && !event.metaKey && !event.altKey;
    const isMine = (event) => letters.checked && isPlain(event) && event.key?.toLowerCase() === key && !isTyping(event);
    const letGo = () => {
      this.#held = null;
      this.#end();
    };
    const down = (event) => {
      if (!isMine(event)) return;
      this.#held = event.code;
      this.#begin();
    };
    addEventListener("keydown", down, until);
    addEventListener("keyup", ({ code }) => code === this.#held && letGo(), until);
    addEventListener("blur", letGo, until);
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
    if (!found) return;
    const press = ++this.#presses;
    const isWanted = () => this.#isOn && press === this.#presses;
    this.animation.rest(); // the next picture of what moves would be in its place at once
    this.#tell(true);
    try {
      const blob = await this.pictures.of(found.settings, found.view);
      if (isWanted()) await this.stage.show(blob, found.caption);
    } catch (error) {
      if (isWanted()) this.#end();
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
