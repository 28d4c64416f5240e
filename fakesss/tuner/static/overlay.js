// The bounding box and the axes over the picture, never part of it.

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }; // to the bounding sphere
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) =>
  [1, 2, 4].filter((bit) => !(corner & bit)).map((bit) => [corner, corner | bit]),
);
const LABEL_PX = 14;
const NEAR = 1e-3; // of clip w: what is at the camera or behind it is left out

export function start(context) {
  return new Overlay(context);
}

class Overlay {
  #canvas = document.getElementById("overlay");
  #drawing = this.#canvas.getContext("2d");
  #header = null;
  #isEmpty = true;
  #shown = { box: false, axes: false };

  constructor({ stage }) {
    this.stage = stage;
    stage.addEventListener("frame", ({ detail }) => {
      this.#header = detail.header;
      this.#draw();
    });
    for (const kind of ["fit", "show", "live"]) stage.addEventListener(kind, () => this.#draw());
  }

  get box() {
    return this.#shown.box;
  }

  set box(isShown) {
    this.#shown.box = isShown;
    this.#draw();
  }

  get axes() {
    return this.#shown.axes;
  }

  set axes(isShown) {
    this.#shown.axes = isShown;
    this.#draw();
  }

  #draw() {
    const isWanted = this.#header?.matrix && this.stage.isLive && (this.box || this.axes); // others may have other cameras
    if (!isWanted && this.#isEmpty) return;
    this.#isEmpty = !isWanted;
    this.#canvas.hidden = !isWanted; // or it would stay where the picture stood, in whatever window
    this.#cover();
    if (!isWanted) return;
    if (this.box) for (const [one, two] of EDGES) this.#line(this.#corner(one), this.#corner(two), 1);
    if (!this.axes) return;
    for (const [name, direction] of Object.entries(AXES)) {
      this.#line([0, 0, 0], direction, 2);
      this.#label(name, direction);
    }
  }

  // As large as the picture on the screen, in that one's pixels; and empty.
  #cover() {
    const { left, top, width, height } = this.stage.canvas.style;
    Object.assign(this.#canvas.style, { left, top, width, height });
    this.#canvas.width = Math.round(parseFloat(width) * devicePixelRatio) || 1;
    this.#canvas.height = Math.round(parseFloat(height) * devicePixelRatio) || 1;
  }

  #corner(number) {
    return this.#header.box[0].map((least, axis) => (number & (1 << axis) ? this.#header.box[1][axis] : least));
  }

  // A white line with a dark edge, to be seen on any picture.
  #line(one, two, thick) {
    const ends = this.#clipped(this.#clip(one), this.#clip(two));
    if (!ends) return;
    const [from, to] = ends.map((point) => this.#pixel(point));
    for (const [colour, wide] of [["#000a", thick + 2], ["#fff", thick]]) {
      Object.assign(this.#drawing, { strokeStyle: colour, lineWidth: wide * devicePixelRatio, lineCap: "round" });
      this.#drawing.beginPath();
      this.#drawing.moveTo(...from);
      this.#drawing.lineTo(...to);
      this.#drawing.stroke();
    }
  }

  // Beside the end of an axis, within the picture.
  #label(name, at) {
    const point = this.#clip(at);
    if (point[3] < NEAR) return;
    const size = LABEL_PX * devicePixelRatio;
    const [x, y] = this.#pixel(point);
    const place = [
      Math.min(Math.max(x + size * 0.7, size), this.#canvas.width - size),
      Math.min(Math.max(y - size * 0.5, size), this.#canvas.height - size),
    ];
    Object.assign(this.#drawing, { font: `600 ${size}px system-ui, sans-serif`, textAlign: "center", textBaseline: "middle" });
    Object.assign(this.#drawing, { strokeStyle: "#000", lineWidth: 3 * devicePixelRatio, fillStyle: "#fff" });
    this.#drawing.strokeText(name, ...place);
    this.#drawing.fillText(name, ...place);
  }

  // Homogeneous clip coordinates of a point in the world.
  #clip([x, y, z]) {
    const m = this.#header.matrix;
    return [0, 4, 8, 12].map((row) => m[row] * x + m[row + 1] * y + m[row + 2] * z + m[row + 3]);
  }

  // The part of a line that is in front of the camera; null if there is none.
  #clipped(one, two) {
    if (one[3] < NEAR && two[3] < NEAR) return null;
    if (one[3] >= NEAR && two[3] >= NEAR) return [one, two];
    const share = (NEAR - one[3]) / (two[3] - one[3]);
    const cut = one.map((from, i) => from + share * (two[i] - from));
    return one[3] < NEAR ? [cut, two] : [one, cut];
  }

  #pixel([x, y, , w]) {
    return [((x / w + 1) / 2) * this.#canvas.width, ((1 - y / w) / 2) * this.#canvas.height];
  }
}
