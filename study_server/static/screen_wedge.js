// Brightness: faint patches on black and white, and grey squares in stripes of black and white. Drawn on canvases with
// one canvas pixel on one device pixel, at every zoom: a stripe that a browser blurs is no longer black or white.
import { onPixelRatio } from "/static/screen.js";

const WEDGE_WIDTH = 640;  // CSS px, where there is room
const WEDGE_HEIGHT = 64;
const MATCH_SIZE = 200;
const STRIPES = { 25: [4, 1], 50: [2, 1], 75: [4, 3] };  // percent: [lines of a period, of these white]

// Patches of the sRGB values data-steps on black or white, the most visible one first.
export function wedge(canvas) {
  const steps = canvas.dataset.steps.split(" ").map(Number);
  const ground = Math.min(...steps) < 128 ? 0 : 255;
  const shown = steps.sort((a, b) => Math.abs(b - ground) - Math.abs(a - ground));
  sharp(canvas, WEDGE_WIDTH, WEDGE_HEIGHT, (paint, width, height) => {
    fill(paint, ground, 0, 0, width, height);
    const wide = width / (1.5 * shown.length + 0.5);
    shown.forEach((value, i) => fill(paint, value, (0.5 + 1.5 * i) * wide, height / 4, wide, height / 2));
  });
}

// Stripes, data-percent of them white, and in their middle a square of the slider's value.
export function match(canvas, slider) {
  const [period, white] = STRIPES[canvas.dataset.percent];
  const square = (paint, width, height) => fill(paint, slider.value, width / 4, height / 4, width / 2, height / 2);
  const redraw = sharp(canvas, MATCH_SIZE, MATCH_SIZE, (paint, width, height) => {
    for (let y = 0; y < height; y++) fill(paint, y % period < white ? 255 : 0, 0, y, width, 1);
    square(paint, width, height);
  });
  slider.addEventListener("input", redraw);
}

// Draws with `draw(context, width, height)` in device pixels, at most `width` x `height` CSS px in its parent's width,
// anew when that width or the device-pixel ratio changes. Gives a function that draws again.
function sharp(canvas, width, height, draw) {
  const room = canvas.parentElement;
  const redraw = () => {
    const style = getComputedStyle(room);
    const free = room.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    if (free <= 0) return;  // not shown yet
    canvas.width = Math.floor(Math.min(width, free) * devicePixelRatio);
    canvas.height = Math.floor(height * devicePixelRatio);
    canvas.style.width = `${canvas.width / devicePixelRatio}px`;
    canvas.style.height = `${canvas.height / devicePixelRatio}px`;
    draw(canvas.getContext("2d"), canvas.width, canvas.height);
  };
  new ResizeObserver(redraw).observe(room);
  onPixelRatio(redraw);
  return redraw;
}

function fill(paint, value, x, y, width, height) {
  paint.fillStyle = `rgb(${value}, ${value}, ${value})`;
  paint.fillRect(Math.round(x), Math.round(y), Math.round(width), Math.round(height));
}
