// Answers that the server has not acknowledged yet, in the order of their trials. They are kept in this browser's storage,
// so that they survive a refresh, a crash and a closed tab. All tabs of a session share them; each answer has a key of its
// own, so that no tab overwrites another's. Where storage is blocked or full an answer is kept in this page's memory.
const LONGEST_MS = 29 * 86_400_000; // the server takes 30 days (answers.py); the day between is for clocks that differ
const PAGE = newName(); // performance.now() counts from the beginning of this page

export class Outbox {
  #prefix;
  #mine = new Map(); // key -> answer put by this page; in storage too, where that works
  #changed;

  // `here`: the session's address. `changed(acknowledged)` is called when another tab has put or removed an answer.
  constructor(here, changed) {
    this.#prefix = `fakesss-outbox ${here} `;
    this.#changed = changed;
    window.addEventListener("storage", (event) => this.#elsewhere(event));
  }

  // `answer` {place, submission, since_shown_ms, ...}: what is sent, with the time as it is now.
  put(answer) {
    const entry = { answer, page: PAGE, steady: performance.now(), clock: Date.now() };
    this.#mine.set(this.#key(answer), entry);
    this.#store();
  }

  remove(answer) {
    this.#mine.delete(this.#key(answer));
    attempt(() => localStorage.removeItem(this.#key(answer)));
  }

  // Oldest trial first; of two tabs' answers to one trial the earlier one first.
  answers() {
    const entries = [...new Map([...this.#stored(), ...this.#mine]).values()];
    entries.sort((a, b) => a.answer.place - b.answer.place || a.clock - b.clock);
    return entries.map(aged);
  }

  has(answer) {
    return this.#mine.has(this.#key(answer)) || attempt(() => localStorage.getItem(this.#key(answer))) !== null;
  }

  // Whether a refresh would lose an answer.
  get isOnlyInMemory() {
    return [...this.#mine.keys()].some((key) => !attempt(() => localStorage.getItem(key)));
  }

  #key(answer) {
    return `${this.#prefix}${answer.place} ${answer.submission}`;
  }

  #stored() {
    const keys = attempt(() => Object.keys(localStorage)) ?? [];
    const ours = keys.filter((key) => key.startsWith(this.#prefix));
    const entries = ours.map((key) => [key, attempt(() => JSON.parse(localStorage.getItem(key)))]);
    return entries.filter(([key, entry]) => entry?.answer && key === this.#key(entry.answer)); // others are not ours
  }

  #store() {
    for (const [key, entry] of this.#mine) attempt(() => localStorage.setItem(key, JSON.stringify(entry)));
  }

  #elsewhere(event) {
    if (event.key === null) return this.#store(); // everything was cleared; what this page put it puts again
    if (!event.key.startsWith(this.#prefix)) return;
    const isGone = event.newValue === null;
    if (isGone) this.#mine.delete(event.key);
    this.#changed(isGone);
  }
}

// The answer with the time that it has waited. The steady clock stops while some computers sleep, and after a reload there
// is another one; the date may be set meanwhile. The longer of the two is nearer the truth, for computers sleep more often
// than they are set forward.
function aged({ answer, page, steady, clock }) {
  const waited = Math.max(Date.now() - clock, page === PAGE ? performance.now() - steady : 0, 0);
  return { ...answer, since_shown_ms: Math.min(Math.round(answer.since_shown_ms + waited), LONGEST_MS) };
}

export function newName() {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

// null where the browser refuses: storage blocked, full, or holding something that is not ours.
function attempt(use) {
  try {
    return use();
  } catch {
    return null;
  }
}
