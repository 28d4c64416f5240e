// Which settings can vary, and levels between two numbers.
import { DIGITS, Scale, written } from "./numbers.js";

export const MOST_LEVELS = 9;

// Every control of the panel that is a number, a choice or a switch, as {path, name, group, scale or choices}.
// Those of the light stand there once, and here once for each light.
export function variables(settings) {
  const further = settings.value("lights").length;
  const found = [];
  for (const element of document.querySelectorAll(".control[data-kind]")) {
    const { path, kind } = element.dataset;
    if (!["number", "choice", "switch"].includes(kind)) continue;
    found.push(variable(element, path));
    const field = path.startsWith("light.") ? path.slice("light.".length) : null;
    for (let index = 0; field && index < further; index++) {
      found.push({ ...variable(element, `lights.${index}.${field}`), group: `Light ${index + 2}` });
    }
  }
  return found;
}

function variable(element, path) {
  const { label, kind } = element.dataset;
  const panel = element.closest("[role=tabpanel]");
  const group = document.getElementById(panel.getAttribute("aria-labelledby")).textContent.trim();
  const name = nameOf(path, label);
  if (kind === "number") return { path, name, group, scale: new Scale(element.dataset) };
  const options = [...element.querySelectorAll("option")].map(({ value, text }) => ({ value: JSON.parse(value), text }));
  const switches = [{ value: true, text: "on" }, { value: false, text: "off" }];
  // a field left empty is no level: a study's file has no word for it
  return { path, name, group, choices: kind === "switch" ? switches : options.filter(({ value }) => value !== null) };
}

// What a reader of the study can tell apart: "light azimuth", "camera azimuth", "blur kernel", "backlight".
function nameOf(path, label) {
  const parts = path.split(".");
  const owner = parts[0] === "lights" ? `light ${Number(parts[1]) + 2}` : parts[0];
  if (parts.at(-1) === "enabled") return owner;
  return parts.length === 1 || owner === "material" ? label : `${owner} ${label}`;
}

// A range around the value now: a quarter of the slider to both sides, or half and twice as much.
export function around(value, scale) {
  if (value === null) return [scale.low, scale.high];
  const reach = (scale.high - scale.low) / 4;
  const ends = scale.isLog && value > 0 ? [value / 2, value * 2] : [value - reach, value + reach];
  const inside = (end) => Math.min(Math.max(end, Math.min(scale.low, value)), Math.max(scale.high, value));
  return ends.map((end) => scale.rounded(inside(end)));
}

// `count` levels between two numbers: the ends as they are, between them as few digits as tell them apart.
export function spaced(from, to, count, isRatios, scale) {
  const levels = Array.from({ length: count }, (_, index) => {
    const share = index / (count - 1);
    if (share === 0 || share === 1) return share ? to : from;
    const value = isRatios ? from * (to / from) ** share : from + share * (to - from);
    return isRatios ? sensible(value, value, 3, scale) : sensible(value, (to - from) / (count - 1), 2, scale);
  });
  return [...new Set(levels)];
}

// `value` as exact as `digits` digits of `size` are; whole or a multiple where the field is.
function sensible(value, size, digits, scale) {
  const unit = scale.multiple ?? (scale.isWhole ? 1 : 10 ** (Math.floor(Math.log10(Math.abs(size) || 1)) + 1 - digits));
  return Number((Math.round(value / unit) * unit).toPrecision(12));
}

// "18, 25 30" as numbers, or the first problem. "0,3" may be one number or two.
export function parsed(text, scale) {
  const unclear = text.split(/[\s;]+/).find((word) => /\d,\d/.test(word) && !word.includes("."));
  if (unclear) return { problem: `Is the comma of "${unclear}" a decimal point? Write a point, or a space after it.` };
  const words = text.split(/[\s,;]+/).filter(Boolean);
  if (!words.length) return { problem: "Give at least one level." };
  const read = words.map((word) => scale.read(word));
  const wrong = read.find(({ problem }) => problem);
  if (wrong) return wrong;
  const levels = read.map(({ value }) => value);
  const twice = levels.find((level, index) => levels.indexOf(level) < index);
  if (twice !== undefined) return { problem: `${written(twice)} stands twice.` };
  if (levels.length > MOST_LEVELS) return { problem: `${levels.length} levels: at most ${MOST_LEVELS} here; add more in study.toml.` };
  return { levels };
}

// A level as it is shown: a number with as many digits as tell it from the others of `levels`.
export function shown(level, levels) {
  if (typeof level === "boolean") return level ? "on" : "off";
  if (typeof level !== "number") return String(level);
  const others = levels.filter((other) => other !== level);
  let digits = DIGITS;
  while (others.some((other) => written(other, digits) === written(level, digits))) digits++;
  return written(level, digits);
}
