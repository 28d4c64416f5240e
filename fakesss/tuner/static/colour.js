// Linear light and sRGB code values, IEC 61966-2-1:1999: the twin of fakesss/colour.py.

const DIGITS = 5; // of linear light: more than enough to come back to the same of 256 codes

export function encodeSrgb(linear) {
  const light = Math.min(Math.max(linear, 0), 1);
  return light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
}

export function decodeSrgb(code) {
  return code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4;
}

// Linear RGB as "#rrggbb". What is brighter than white keeps its hue: it is shown as bright as white goes.
export function toHex(linear) {
  const most = Math.max(...linear, 1);
  const codes = linear.map((light) => Math.floor(encodeSrgb(light / most) * 255 + 0.5));
  return `#${codes.map((code) => code.toString(16).padStart(2, "0")).join("")}`;
}

// Linear RGB of "#rrggbb", times `most`: what `toHex` left out.
export function fromHex(hex, most = 1) {
  const codes = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  return codes.map((code) => Number((decodeSrgb(code) * most).toPrecision(DIGITS)));
}
