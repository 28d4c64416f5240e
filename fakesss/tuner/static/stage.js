// The picture, pixel by pixel, and what is to be said of it.
//
// Events: "frame" ({header, asked, latency}) when any frame is on the canvas, "still" after one that is as the scene
// says, "show" when another picture was put in its place, "live" when it is back, "fit" when it has another place or size
// on the screen, "view" when another intermediate is looked at.

const AS_IT_IS = { premultiplyAlpha: "none", colorSpaceConversion: "none" };
const INPUTS = ["pointerdown", "pointermove", "pointerup", "wheel", "keydown", "keyup", "input", "change", "click"];
const BUSY_MS = 1000; // no page is busy for longer between an input and what it changes

export function start(context) {
  return new Stage(context);
}

class Stage extends EventTarget {
  place = document.getElementById("place"); // what is dragged in, and has the focus for the keys
  canvas = document.getElementById("picture");
  #drawing = this.canvas.getContext("2d");
  #select = document.getElementById("view");
  #caption = document.getElementById("caption");
  #live = null; // {bitmap, size, header}: the last frame
  #still = null; // {blob, header, settings}
  #other = null; // {bitmap, caption}: shown in its place for a while
  #showing = 0; // counts what `show` was asked for: decoding may overtake
  #touchedAt = -Infinity;

  constructor({ settings, connection, start, say }) {
    super();
    Object.assign(this, { settings, connection, say });
    for (const [name, title] of Object.entries(start.views)) this.#select.add(new Option(title, name));
    this.#select.addEventListener("change", () => (this.view = this.#select.value));
    for (const kind of INPUTS) addEventListener(kind, (event) => this.#touched(event), { capture: true, passive: true });
    settings.addEventListener("change", ({ detail }) => this.#changed(detail));
    connection.addEventListener("frame", ({ detail }) => this.#receive(detail));
    new ResizeObserver(() => this.#fit()).observe(this.place);
    onPixelRatio(() => this.#fit());
    this.redraw();
  }

  // Ask for the picture anew.
  redraw(asked = performance.now()) {
    const wish = { settings: this.settings.current, view: this.view, moving: this.settings.isMoving };
    this.connection.wish(wish, asked);
  }

  // The intermediate that is looked at, or "picture".
  get view() {
    return this.#select.value;
  }

  set view(name) {
    this.#select.value = name;
    this.showLive();
    this.redraw();
    this.#tell("view", { view: name });
  }

  // The last still frame {blob, header, settings}; null before the first.
  picture() {
    return this.#still;
  }

  get isLive() {
    return this.#other === null;
  }

  // Put another picture in its place, until `showLive` or the next change of the settings.
  async show(blob, caption) {
    const number = ++this.#showing;
    const bitmap = await createImageBitmap(blob, AS_IT_IS);
    if (number !== this.#showing) return bitmap.close();
    this.#other?.bitmap.close();
    this.#other = { bitmap, size: [bitmap.width, bitmap.height], caption };
    this.#paint();
    this.#tell("show");
  }

  showLive() {
    this.#showing++;
    if (this.isLive) return;
    this.#other.bitmap.close();
    this.#other = null;
    this.#paint();
    this.#tell("live");
  }

  #touched(event) {
    // pointer moves are gathered until the browser draws: the first of them is what the hand did first
    this.#touchedAt = (event.getCoalescedEvents?.()[0] ?? event).timeStamp;
  }

  #changed({ byHand }) {
    const now = performance.now();
    this.showLive();
    this.redraw(byHand && now - this.#touchedAt < BUSY_MS ? this.#touchedAt : now);
  }

  async #receive({ header, image, asked, wish }) {
    try {
      const bitmap = await createImageBitmap(image, AS_IT_IS);
      if (header.number < this.#live?.header.number) return bitmap.close(); // a smaller one was decoded sooner
      this.#live?.bitmap.close();
      // a moving frame may be smaller than the picture in whose place it stands
      const size = header.moving ? this.settings.valueIn(wish.settings, "size") : [header.width, header.height];
      this.#live = { bitmap, size, header };
      if (!header.moving) this.#still = { blob: image, header, settings: wish.settings };
      if (this.isLive) this.#paint();
      Object.assign(this.place.dataset, { wish: header.number, moving: header.moving }); // for who measures and tests
      this.#tell("frame", { header, asked, latency: performance.now() - asked });
      if (!header.moving) this.#tell("still");
    } catch {
      this.say("error", "A picture came damaged; the one before stays.");
    } finally {
      this.connection.shown(header.number);
    }
  }

  #paint() {
    const { bitmap, size } = this.#other ?? this.#live ?? {};
    if (!bitmap) return;
    const [width, height] = size;
    const isOtherSize = this.canvas.width !== width || this.canvas.height !== height;
    if (isOtherSize) Object.assign(this.canvas, { width, height });
    else this.#drawing.clearRect(0, 0, width, height);
    this.#drawing.drawImage(bitmap, 0, 0, width, height);
    this.#tellCaption();
    if (isOtherSize) this.#fit();
  }

  // That of another picture takes the room that there is, whatever it says: the picture must not move.
  #tellCaption() {
    const words = this.#other?.caption ?? [this.#live.header.note, this.#live.header.stand_in].filter(Boolean).join(" ");
    this.#caption.style.height = this.#other ? `${this.#caption.offsetHeight}px` : "";
    this.#caption.title = this.#other ? words : "";
    this.#caption.textContent = words;
  }

  // One pixel of the picture on one of the screen, unless there is too little room. It is moved onto whole device pixels:
  // between two of them it would be blurred.
  #fit() {
    if (!this.#live && !this.#other) return;
    const { clientWidth, clientHeight } = this.place;
    const { width, height, style } = this.canvas;
    const scale = Math.min(1, (clientWidth * devicePixelRatio) / width, (clientHeight * devicePixelRatio) / height);
    const [wide, high] = [width, height].map((pixels) => (pixels * scale) / devicePixelRatio);
    Object.assign(style, { width: `${wide}px`, height: `${high}px` });
    const corner = this.place.getBoundingClientRect();
    style.left = `${onPixels(corner.left + (clientWidth - wide) / 2) - corner.left}px`;
    style.top = `${onPixels(corner.top + (clientHeight - high) / 2) - corner.top}px`;
    const words = scale < 1 ? `${width} × ${height} pixels, shown at ${Math.floor(scale * 100)} %` : `${width} × ${height} pixels`;
    const place = document.getElementById("scale");
    if (place.textContent !== words) place.textContent = words;
    this.#tell("fit");
  }

  #tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}

function onPixels(at) {
  return Math.round(at * devicePixelRatio) / devicePixelRatio;
}

// Calls `changed` whenever the device-pixel ratio does: zoom resizes the window, a move to another screen need not.
function onPixelRatio(changed) {
  const again = () => {
    changed();
    onPixelRatio(changed);
  };
  matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", again, { once: true });
}
