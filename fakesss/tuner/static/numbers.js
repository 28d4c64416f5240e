// A number's limits, its place on a slider, and how it is read and written.

export const DIGITS = 5; // shown; of small numbers, whose zeros take room, one fewer
const LOG_STEPS = 100; // key presses from one end of a logarithmic slider to the other
const PLACES = 1000; // on a slider

const GROUPED = /^-?[1-9]\d{0,2},\d{3}$/; // 60,000 is sixty to some and sixty thousand to others

// What a control's element says of its numbers (fakesss.tuner.controls.Control.data).
export class Scale {
  constructor({ low, high, step, log, least, most, above, whole, multiple, label }) {
    Object.assign(this, { low: Number(low), high: Number(high), step: Number(step), label });
    this.least = least === undefined ? -Infinity : Number(least);
    this.most = most === undefined ? Infinity : Number(most);
    this.multiple = multiple === undefined ? null : Number(multiple);
    this.isLog = log !== undefined;
    this.isAbove = above !== undefined; // `least` itself is refused
    this.isWhole = whole !== undefined;
  }

  // Places are 0..PLACES from the low to the high end, whatever lies beyond at the ends.
  place(value) {
    const { low, high } = this;
    const share = this.isLog ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
    return PLACES * Math.min(Math.max(share, 0), 1);
  }

  at(place) {
    const { low, high } = this;
    const share = place / PLACES;
    return this.rounded(this.isLog ? low * (high / low) ** share : low + share * (high - low));
  }

  // So many key presses on from `value`; no further than the field accepts.
  stepped(value, steps) {
    const ratio = (this.high / this.low) ** (1 / LOG_STEPS);
    const to = this.isLog ? Math.max(value, this.low) * ratio ** steps : value + steps * this.step;
    return this.within(this.rounded(to));
  }

  // As few digits as the step, or three where steps are ratios.
  rounded(value) {
    const unit = this.multiple ?? (this.isWhole ? 1 : this.isLog ? 0 : this.step);
    const near = unit ? Math.round(value / unit) * unit : Number(value.toPrecision(3));
    return Number(near.toPrecision(12));
  }

  within(value) {
    const least = this.isAbove ? Math.max(this.least, this.low) : this.least;
    return Math.min(Math.max(value, least), this.most);
  }

  // What was typed, as {value} or {problem}: "0.25", "0,25", "1e-3" and "1/256" are numbers.
  read(text) {
    const typed = text.trim();
    const [top, bottom = "1", ...rest] = typed.replaceAll(",", ".").split("/");
    const value = rest.length || !top.trim() || !bottom.trim() ? NaN : Number(top) / Number(bottom);
    if (!Number.isFinite(value)) return { problem: `"${typed}" is not a number.` };
    if (GROUPED.test(this.isWhole ? typed.replace(".", ",") : typed)) {
      return { problem: `"${typed}" may be ${value} or ${typed.replace(/[.,]/, "")}: write one of these.` };
    }
    if (this.isWhole && !Number.isInteger(value)) return { problem: `${this.label} must be a whole number.` };
    if (this.multiple && value % this.multiple) return { problem: `${this.label} must be a multiple of ${this.multiple}.` };
    if (this.isAbove && value <= this.least) return { problem: `${this.label} must be more than ${this.least}.` };
    if (value < this.least) return { problem: `${this.label} must be at least ${written(this.least)}.` };
    if (value > this.most) return { problem: `${this.label} must be at most ${written(this.most)}.` };
    return { value };
  }
}

// Whole numbers in full, others with so many digits.
export function written(value, digits = DIGITS) {
  if (value === null || value === undefined) return "";
  return String(Number.isInteger(value) ? value : Number(value.toPrecision(Math.abs(value) < 0.1 ? digits - 1 : digits)));
}

// Degrees in -180..180, to a hundredth.
export function wrapped(degrees) {
  const turned = ((((degrees + 180) % 360) + 360) % 360) - 180;
  return Number(turned.toFixed(2));
}
