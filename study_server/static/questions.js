// The questions under a picture: built anew for each trial, answered by mouse, touch or keys, each choice timed.

const BUSY_MS = 1_000; // no page is busy for longer between a key and what it changes

export class Questions {
  #fieldsets = [];
  #asked = [];
  #rtMs = [];
  #touchedAt = -Infinity; // by a key, a finger or the mouse; the page may have been busy when it was

  // `place` holds the fieldsets, `template` is one; `next` is the button after them; `elapsed(at)` the time since the
  // picture's first frame at the page's time `at`.
  constructor(place, template, next, elapsed) {
    Object.assign(this, { place, template, next, elapsed });
    place.addEventListener("change", (event) => this.#chosen(event.target, event));
    for (const kind of ["keydown", "keyup", "pointerup"]) {
      next.form.addEventListener(kind, (event) => (this.#touchedAt = event.timeStamp), { capture: true });
    }
    next.form.addEventListener("keydown", (event) => this.#digit(event)); // only while the focus is in it (WCAG 2.1.4)
  }

  // Put questions {name, text, scale, low, high} on the page, closed until the picture is there.
  ask(questions) {
    this.#asked = questions;
    this.#rtMs = questions.map(() => null);
    this.#fieldsets = questions.map((question, number) => this.#fieldset(question, number));
    this.place.replaceChildren(...this.#fieldsets);
    this.#refreshNext();
  }

  #fieldset({ text, scale, low, high }, number) {
    const fieldset = this.template.content.firstElementChild.cloneNode(true);
    fieldset.querySelector("legend").textContent = text;
    fieldset.querySelectorAll(".ends span").forEach((end, i) => (end.textContent = i ? high : low));
    const label = fieldset.querySelector("label");
    for (let step = 1; step <= scale; step++) {
      const choice = label.cloneNode(true);
      const radio = choice.querySelector("input");
      Object.assign(radio, { name: `question-${number}`, value: step });
      choice.querySelector("span").textContent = step;
      if (step === 1 || step === scale) radio.setAttribute("aria-label", `${step}, ${step === 1 ? low : high}`);
      label.before(choice);
    }
    label.remove();
    return fieldset;
  }

  get isOpen() {
    return !this.place.inert && this.#fieldsets.some((fieldset) => !fieldset.disabled);
  }

  open() {
    for (const fieldset of this.#fieldsets) fieldset.disabled = false;
  }

  // `hide`: out of sight as well. Otherwise what was answered stays to be seen while it is being saved.
  close({ hide }) {
    this.place.inert = !hide;
    for (const fieldset of this.#fieldsets) fieldset.disabled = hide;
  }

  // The first question without an answer; -1 if there is none.
  get firstOpen() {
    return this.#rtMs.indexOf(null);
  }

  get isUntouched() {
    return this.#rtMs.every((ms) => ms === null);
  }

  answers() {
    return this.#asked.map(({ name }, i) => ({
      question: name,
      rating: Number(this.#fieldsets[i].querySelector("input:checked").value),
      rt_ms: this.#rtMs[i],
    }));
  }

  // Under a new picture: focus on the first question, or, while that is out of sight, only in the form, where Space and
  // arrows scroll as usual.
  focusOnFirst() {
    const { top, bottom } = this.#fieldsets[0].getBoundingClientRect();
    if (top >= 0 && bottom <= innerHeight) this.focusOn(0);
    else this.next.form.focus({ preventScroll: true });
  }

  // Focus on a question's answer, or its first step; past the last question on Next.
  focusOn(index) {
    const fieldset = this.#fieldsets[index];
    const target = fieldset ? (fieldset.querySelector("input:checked") ?? fieldset.querySelector("input")) : this.next;
    target.focus();
  }

  #chosen(radio, event) {
    const waited = event.timeStamp - this.#touchedAt; // a change by anything else, a screen reader say, is its own time
    const at = waited >= 0 && waited < BUSY_MS ? this.#touchedAt : event.timeStamp;
    this.#rtMs[this.#fieldsets.indexOf(radio.closest("fieldset"))] = this.elapsed(at);
    this.#refreshNext();
  }

  // Keys 1-9 and 0 for ten answer the question that has the focus, else the first open one; the focus moves on.
  #digit(event) {
    if (!this.isOpen || event.repeat || event.ctrlKey || event.metaKey || event.altKey) return;
    const key = digitOf(event);
    if (key === undefined) return;
    const focused = this.#fieldsets.findIndex((fieldset) => fieldset.contains(document.activeElement));
    const index = focused >= 0 ? focused : this.firstOpen;
    const radio = this.#fieldsets[index]?.querySelector(`input[value="${Number(key) || 10}"]`);
    if (!radio) return;
    event.preventDefault();
    radio.checked = true;
    this.#chosen(radio, event);
    this.focusOn(index + 1);
  }

  #refreshNext() {
    this.next.setAttribute("aria-disabled", this.#rtMs.includes(null));
  }
}

// The digit that a key is for; French keyboards have them where others have none.
function digitOf({ key, code, shiftKey }) {
  if (/^[0-9]$/.test(key)) return key;
  return shiftKey ? undefined : /^Digit([0-9])$/.exec(code)?.[1];
}
