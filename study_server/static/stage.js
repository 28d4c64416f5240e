// The place where one picture stands: never a wrong one, and never a shrunk one where the study refuses that.
import { Damaged, duePicture } from "/static/pictures.js";
import { drawn, fitToPixels, frame, isScaled, screenFacts } from "/static/screen.js";

export class Stage {
  #image = null;
  #smallest = null; // how it was drawn when it was smallest: what a participant saw is not better than that

  // `place` is the element, `words` the page's; `isShrinkingRefused` as the study says; `covered(bool)` is called when
  // the picture disappears because it does not fit, and when it is back.
  constructor(place, words, covered) {
    Object.assign(this, { place, words, covered });
    this.isShrinkingRefused = false;
    this.notice = paragraph("does-not-fit", words.doesNotFit);
    window.addEventListener("resize", () => this.#image && this.#fit());
    document.addEventListener("visibilitychange", () => this.#image && this.#fit());
    followRatio();
  }

  // Put this picture on the page as soon as it is there and can be seen; resolves to its hash.
  async show(facts) {
    this.#image = null;
    this.place.style.minHeight = `${facts.height / devicePixelRatio}px`; // words take the picture's place
    const image = await this.#undamaged(facts);
    image.alt = this.words.alt;
    this.place.replaceChildren(image, this.notice);
    this.place.style.minHeight = "";
    this.#image = image;
    this.#smallest = null;
    this.#fit();
    while (this.isCovered) await new Promise((resolve) => window.addEventListener("resize", resolve, { once: true }));
    return image.dataset.sha256;
  }

  get isCovered() {
    return this.place.classList.contains("covered");
  }

  display() {
    return { ...screenFacts(), ...(this.#smallest ?? this.#drawn()) };
  }

  #fit() {
    if (!this.place.parentElement.clientWidth) return; // browsers pass through a window of 1 x 1 while they resize
    this.notice.hidden = true; // it would move the picture
    fitToPixels(this.#image);
    const isCovered = isScaled(this.#image) && this.isShrinkingRefused;
    this.place.classList.toggle("covered", isCovered);
    this.notice.hidden = !isCovered;
    this.#noteOncePainted(this.#image, this.#drawn());
    this.covered(isCovered);
  }

  #drawn() {
    return { ...drawn(this.#image), scaled: isScaled(this.#image) };
  }

  // A size counts if a frame with it was painted, and somebody could look at it: frames come only while the page is
  // visible, and the first one begins before anything is painted.
  async #noteOncePainted(image, then) {
    await frame();
    await frame();
    if (image !== this.#image || this.isCovered || document.visibilityState !== "visible") return;
    const now = this.#drawn();
    if (now.drawn_width_px !== then.drawn_width_px) return; // it is another already, of which `#fit` tells
    if (!this.#smallest || now.drawn_width_px < this.#smallest.drawn_width_px) this.#smallest = now;
  }

  // The picture, however long it takes; a picture that is not exactly the right one is never shown.
  async #undamaged(facts) {
    for (let attempt = 1; ; attempt++) {
      try {
        return await duePicture(facts);
      } catch (error) {
        const sentence = error instanceof Damaged ? this.words.damaged : this.words.unloaded;
        const notice = paragraph("waiting", attempt > 4 ? `${sentence} ${this.words.tellUs}` : sentence);
        this.place.replaceChildren(notice);
        await new Promise((resolve) => setTimeout(resolve, Math.min(500 * 2 ** attempt, 10_000)));
      }
    }
  }
}

// A window that is moved to a screen of another ratio may keep its size: nothing but this tells of it.
function followRatio() {
  const media = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
  const changed = () => {
    window.dispatchEvent(new Event("resize"));
    followRatio();
  };
  media.addEventListener("change", changed, { once: true });
}

function paragraph(id, sentence) {
  const words = Object.assign(document.createElement("p"), { id, textContent: sentence });
  words.setAttribute("role", "alert");
  return words;
}
