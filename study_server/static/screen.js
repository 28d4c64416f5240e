// Where and how large the picture stands on the screen, and for how long.

// One file pixel on one device pixel, unless the window is too narrow; then CSS shrinks it and drawn_width_px says so.
// Where layout leaves the picture between two pixels, browsers move it to the nearest; a transform would blur it.
export function fitToPixels(image) {
  if (!image) return;
  image.style.width = `${image.naturalWidth / devicePixelRatio}px`;
}

export function display(image) {
  return {
    device_pixel_ratio: devicePixelRatio,
    // Desktop browsers count page zoom in innerWidth; pinch zoom is the visual viewport's scale.
    zoom: round((outerWidth / innerWidth || 1) * (visualViewport?.scale ?? 1), 3),
    drawn_width_px: round(image.getBoundingClientRect().width * devicePixelRatio, 2),
    window_width_px: innerWidth,
    window_height_px: innerHeight,
  };
}

// Time since a picture's first frame, and how much of it the page was hidden or not in front.
export class Stopwatch {
  shownAt = null;
  away = 0;
  awaySince = null;

  constructor() {
    for (const name of ["blur", "focus"]) window.addEventListener(name, () => this.look());
    document.addEventListener("visibilitychange", () => this.look());
  }

  look() {
    const seen = document.visibilityState === "visible" && document.hasFocus();
    if (seen && this.awaySince !== null) {
      this.away += performance.now() - this.awaySince;
      this.awaySince = null;
    } else if (!seen && this.awaySince === null) this.awaySince = performance.now();
  }

  // Frames come only while the page is visible. The first callback runs before the frame with the picture is painted;
  // the second one's time stamp is the first moment at which it surely is on screen.
  async start() {
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    await frame();
    this.shownAt = await frame();
    this.away = 0;
    this.awaySince = null;
    this.look();
  }

  elapsed() {
    return round(performance.now() - this.shownAt, 1);
  }

  lost() {
    const now = this.awaySince === null ? 0 : performance.now() - this.awaySince;
    return round(this.away + now, 1);
  }
}

function round(x, digits) {
  return Number(x.toFixed(digits));
}
