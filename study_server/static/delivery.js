// Brings the outbox to the server: the answers in their order, one at a time, each until it is acknowledged.
import { askWhere, pause, send } from "/static/sending.js";

const OTHER_TAB_MS = 3_000;

export class Delivery {
  page = null; // the server's latest dict of where the session stands; null: not known
  isStale = false; // another tab has brought something to the server since
  isFailing = false; // the latest attempt got no answer
  #doubted = null; // {answer, sentence}: refused; where the session stands decides what becomes of it
  #isOver = false; // the session is somewhere else now; what is left is for that page to send
  #running = null;

  // `heard()` after every attempt; `refused(sentence)` when an answer is given up; `lost()` when the session is refused.
  constructor(here, step, outbox, { heard, refused, lost }) {
    Object.assign(this, { here, step, outbox, heard, refused, lost });
  }

  // Resolves when all that can be sent is saved and `page` is up to date.
  run() {
    this.#running ??= this.#deliver().finally(() => (this.#running = null));
    return this.#running;
  }

  get isRunning() {
    return this.#running !== null;
  }

  // The first answer that the server takes now. After a refusal later ones wait until their trial's turn has come.
  get sendable() {
    const [first] = this.outbox.answers();
    return first && !this.#doubted && (this.page?.place ?? first.place) >= first.place ? first : undefined;
  }

  async #deliver() {
    for (let failures = 0; !this.#isOver; ) {
      const answer = this.sendable;
      if (!answer && this.page && !this.isStale) return;
      const wasStale = this.isStale;
      this.isStale = false; // what another tab brings from here on may come after this reply was made
      const reply = await (answer ? this.#alone(() => this.#post(answer, failures)) : askWhere(this.here, failures));
      this.isFailing = "after" in reply;
      if (this.isFailing) this.isStale ||= wasStale;
      else this.#take(answer, reply);
      this.heard();
      failures = this.isFailing ? failures + 1 : 0;
      if (this.isFailing) await pause(failures, reply.after);
    }
  }

  // Another tab may have sent it while this one waited for its turn.
  async #post(answer, failures) {
    if (!this.outbox.has(answer)) return { page: null };
    const reply = await send(this.here, answer, failures);
    if (reply.page) this.outbox.remove(answer); // before the next tab's turn
    return reply;
  }

  #take(answer, { page = null, refused }) {
    if (refused === undefined && !answer) this.#judge(page);
    else if (refused !== undefined && answer) this.#doubted = { answer, sentence: refused };
    else if (refused !== undefined) {
      this.#isOver = true;
      this.lost();
    }
    this.page = page;
  }

  // A refused answer is given up if it was its turn. If the server is behind it (restored from a backup, say), it waits.
  #judge(page) {
    if (!this.#doubted) return;
    const { answer, sentence } = this.#doubted;
    this.#doubted = null;
    if (page.step !== this.step) this.#isOver = true;
    else if (!(page.place < answer.place)) {
      this.outbox.remove(answer);
      this.refused(sentence);
    }
  }

  // One tab at a time, as far as the browser knows locks (on HTTPS and localhost). A tab that was put to sleep with the
  // lock in its hand is not waited for: the server stores an answer once, however often it comes.
  async #alone(work) {
    let begun = false;
    const once = () => {
      begun = true;
      return work();
    };
    try {
      return await navigator.locks.request(`fakesss ${this.here}`, { signal: AbortSignal.timeout(OTHER_TAB_MS) }, once);
    } catch {
      return begun ? { after: 0 } : work();
    }
  }
}
