// The place where one picture stands: never a wrong one, and never a shrunk one where the study refuses that.
import { Damaged, duePicture } from "/static/pictures.js";
import { drawn, fitToPixels, frame, isScaled, onPixelRatio, screenFacts } from "/static/screen.js";

const LATE_MS = 300; // from here on the picture before would be taken for the one that is counted

export class Stage {
  #image = null;
  #worst = null; // how it stood when it was farthest from its file's size: what a participant saw is not better than that

  // `place` is the element, `words` the page's; `isShrinkingRefused` as the study says; `covered(bool)` is called when
  // the picture disappears because it does not fit, and when it is back.
  constructor(place, words, covered) {
    Object.assign(this, { place, words, covered });
    this.isShrinkingRefused = false;
    this.notice = paragraph("does-not-fit", words.doesNotFit);
    const fit = () => this.#image && this.#fit();
    window.addEventListener("resize", fit);
    visualViewport?.addEventListener("resize", fit); // two fingers
    document.addEventListener("visibilitychange", fit);
    onPixelRatio(fit);
  }

  // Put this picture on the page as soon as it is there and can be seen; resolves to its hash.
  async show(facts) {
    this.#image = null;
    this.place.style.minHeight = `${facts.height / devicePixelRatio}px`; // words take the picture's place
    const isLate = setTimeout(() => this.place.replaceChildren(this.#loading()), LATE_MS);
    const image = await this.#undamaged(facts, isLate);
    image.alt = this.words.alt;
    this.place.replaceChildren(image, this.notice);
    this.place.style.minHeight = "";
    this.#image = image;
    this.#worst = null;
    this.#fit();
    while (this.isCovered) await frame();
    return image.dataset.sha256;
  }

  get isCovered() {
    return this.place.classList.contains("covered");
  }

  display() {
    return this.#worst ?? this.#now();
  }

  #fit() {
    if (!this.place.parentElement.clientWidth) return; // browsers pass through a window of 1 x 1 while they resize
    this.notice.hidden = true; // it would move the picture
    fitToPixels(this.#image);
    const isCovered = isScaled(this.#image) && this.isShrinkingRefused;
    this.place.classList.toggle("covered", isCovered);
    this.notice.hidden = !isCovered;
    this.#noteOncePainted(this.#image, this.#now());
    this.covered(isCovered);
  }

  #now() {
    return { ...screenFacts(), ...drawn(this.#image), scaled: isScaled(this.#image) };
  }

  // A size counts if a frame with it was painted, and somebody could look at it: frames come only while the page is
  // visible, and the first one begins before anything is painted.
  async #noteOncePainted(image, then) {
    await frame();
    await frame();
    if (image !== this.#image || this.isCovered || document.visibilityState !== "visible") return;
    const now = this.#now();
    if (now.drawn_width_px !== then.drawn_width_px) return; // it is another already, of which `#fit` tells
    const stretched = ({ drawn_width_px }) => Math.abs(Math.log(drawn_width_px / image.naturalWidth));
    if (!this.#worst || stretched(now) >= stretched(this.#worst)) this.#worst = now;
  }

  #loading() {
    return Object.assign(document.createElement("p"), { id: "waiting", textContent: this.words.loading });
  }

  // The picture, however long it takes; a picture that is not exactly the right one is never shown.
  async #undamaged(facts, isLate) {
    for (let attempt = 1; ; attempt++) {
      try {
        return await duePicture(facts).finally(() => clearTimeout(isLate));
      } catch (error) {
        const sentence = error instanceof Damaged ? this.words.damaged : this.words.unloaded;
        const notice = paragraph("waiting", attempt > 4 ? `${sentence} ${this.words.tellUs}` : sentence);
        this.place.replaceChildren(notice);
        await new Promise((resolve) => setTimeout(resolve, Math.min(500 * 2 ** attempt, 10_000)));
      }
    }
  }
}

function paragraph(id, sentence) {
  const words = Object.assign(document.createElement("p"), { id, textContent: sentence });
  words.setAttribute("role", "alert");
  return words;
}
