// Where and how large the picture stands on the screen, and for how long.

const GAMUTS = ["rec2020", "p3", "srgb"]; // widest first
const MOST_MS = 30 * 86_400_000; // the server takes no longer time (answers.py)

// One file pixel on one device pixel, unless the window is too narrow; then CSS shrinks it and `drawn` says so. The picture
// is moved onto whole device pixels: halfway between two of them, its two edges may be rounded apart.
export function fitToPixels(image) {
  image.style.width = `${image.naturalWidth / devicePixelRatio}px`;
  image.style.left = image.style.top = "0px";
  const { left, top } = image.getBoundingClientRect();
  image.style.left = `${offset(left + scrollX)}px`;
  image.style.top = `${offset(top + scrollY)}px`;
}

// CSS pixels from `at` to the nearest whole device pixel.
function offset(at) {
  return (Math.round(at * devicePixelRatio) - at * devicePixelRatio) / devicePixelRatio;
}

// Width and height in device pixels. Two fingers enlarge what is laid out: a page that wants to know has to ask.
export function drawn(image) {
  const { width, height } = image.getBoundingClientRect();
  const enlarged = devicePixelRatio * pinched();
  return { drawn_width_px: round(width * enlarged, 2), drawn_height_px: round(height * enlarged, 2) };
}

function pinched() {
  return visualViewport?.scale ?? 1;
}

export function isScaled(image) {
  const { drawn_width_px, drawn_height_px } = drawn(image);
  return Math.max(Math.abs(drawn_width_px - image.naturalWidth), Math.abs(drawn_height_px - image.naturalHeight)) > 0.5;
}

export function screenFacts() {
  // Desktop browsers count page zoom in innerWidth; pinch zoom is the visual viewport's scale.
  const zoom = (outerWidth / innerWidth || 1) * pinched();
  return {
    device_pixel_ratio: devicePixelRatio,
    zoom: round(Math.min(Math.max(zoom, 0.01), 100), 3),
    window_width_px: innerWidth,
    window_height_px: innerHeight,
    gamut: GAMUTS.find((name) => matchMedia(`(color-gamut: ${name})`).matches) ?? "",
  };
}

// Calls `changed` whenever the device-pixel ratio does: zoom resizes the window, a move to another screen need not.
export function onPixelRatio(changed) {
  const media = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
  const again = () => {
    changed();
    onPixelRatio(changed);
  };
  media.addEventListener("change", again, { once: true });
}

// Resolves with the time stamp of the next frame, before that is painted.
export function frame() {
  return new Promise((resolve) => requestAnimationFrame(resolve));
}

// Time since a picture's first frame, and how much of it the picture could not be seen: the page hidden or not in front,
// or the picture taken away (`cover`) because it does not fit.
export class Stopwatch {
  shownAt = 0;
  away = 0;
  awaySince = null;
  isCovered = false;

  constructor() {
    for (const name of ["blur", "focus"]) window.addEventListener(name, () => this.look());
    document.addEventListener("visibilitychange", () => this.look());
  }

  cover(isCovered) {
    this.isCovered = isCovered;
    this.look();
  }

  look() {
    const seen = document.visibilityState === "visible" && document.hasFocus() && !this.isCovered;
    if (seen && this.awaySince !== null) {
      this.away += performance.now() - this.awaySince;
      this.awaySince = null;
    } else if (!seen && this.awaySince === null) this.awaySince = performance.now();
  }

  // Frames come only while the page is visible. The first callback runs before the frame with the picture is painted;
  // the second one's time stamp is the first moment at which it surely is on screen. `earlier` {shownAt, away, seenUntil},
  // ms since 1970: the same picture before this page was loaded anew. It goes on, and the time between was away.
  async start(earlier) {
    await frame();
    const now = await frame();
    this.shownAt = now;
    this.away = 0;
    if (earlier) {
      this.shownAt -= Math.max(Date.now() - earlier.shownAt, 0);
      this.away = earlier.away + Math.max(Date.now() - earlier.seenUntil, 0);
    }
    this.awaySince = null;
    this.look();
  }

  // What `start` needs to go on after the page was loaded anew.
  kept() {
    return { shownAt: Date.now() - this.elapsed(), away: this.lost(), seenUntil: Date.now() };
  }

  // Until the page's time `at`.
  elapsed(at = performance.now()) {
    return limited(at - this.shownAt);
  }

  lost() {
    const now = this.awaySince === null ? 0 : performance.now() - this.awaySince;
    return limited(this.away + now);
  }
}

function limited(ms) {
  return round(Math.min(Math.max(ms, 0), MOST_MS), 1);
}

function round(x, digits) {
  return Number(x.toFixed(digits));
}
