// How two pictures differ: the absolute difference of what is displayed, 8 bits a channel, from lossless pictures.
import { isSame } from "./settings.js";

const LIVE = "live";
const BEFORE = "before";

export function start({ settings, stage, animation, say }, pictures, pins) {
  const [one, other, gain, button, words] = ["difference-one", "difference-other", "difference-gain", "show-difference", "difference-words"].map(
    (id) => document.getElementById(id),
  );
  let isOn = false;
  let number = 0; // of the last one asked for: pictures may come in another order

  // What a choice stands for; null where there is nothing, or not yet.
  function chosen(name) {
    if (name === LIVE) return { settings: settings.current, view: stage.view };
    if (name === BEFORE) return settings.previous && { settings: settings.previous, view: stage.view };
    return pins.all.find(({ id }) => id === name);
  }

  async function show() {
    const mine = ++number;
    const both = [one, other].map(({ value }) => chosen(value));
    if (both.includes(null)) return tell("There is no setting before this one.");
    try {
      const [first, second] = await Promise.all(both.map(async (each) => pixels(await pictures.of(each.settings, each.view))));
      if (mine !== number || settings.isMoving) return;
      if (first.width !== second.width || first.height !== second.height) {
        return tell(`These pictures have different sizes: ${first.width} × ${first.height} and ${second.width} × ${second.height}.`);
      }
      const found = difference(first, second, Number(gain.value));
      const named = [one, other].map(({ selectedOptions }) => selectedOptions[0].textContent).join(" and ");
      await stage.show(found.image, `Difference of ${named}, times ${gain.value}`);
      tell(inWords(found));
    } catch (error) {
      say("error", error.message);
    }
  }

  function tell(sentence) {
    words.textContent = sentence;
  }

  function turn(isShown) {
    isOn = isShown;
    button.setAttribute("aria-pressed", isOn);
    if (isOn) {
      animation.rest(); // a difference is one of pictures that rest
      return show();
    }
    forget();
    stage.showLive();
  }

  // What was chosen stays, as long as it is there.
  function fill(select, start) {
    const value = select.dataset.chosen ?? start;
    const options = [new Option("live", LIVE), new Option("before", BEFORE)];
    options.push(...pins.all.map(({ name, id }) => new Option(name, id)));
    select.replaceChildren(...options);
    select.value = options.some((option) => option.value === value) ? value : start;
  }

  function refill() {
    const before = [one.value, other.value];
    fill(one, LIVE);
    fill(other, pins.all[0]?.id ?? BEFORE);
    if (isOn && !pins.all.length) return turn(false); // its place is gone
    if (one.value === before[0] && other.value === before[1]) return;
    forget();
    again();
  }

  // What is said, or being computed, is of other pictures than those that are chosen now.
  function forget() {
    number++;
    tell("");
  }

  // Once the live picture is as it will be, and whenever another one is no longer looked at.
  const again = () => isOn && isSame(stage.picture()?.settings, settings.current) && show();
  settings.addEventListener("change", forget);
  stage.addEventListener("view", forget);
  stage.addEventListener("still", again);
  stage.addEventListener("live", again);
  pins.addEventListener("change", refill);
  button.addEventListener("click", () => turn(!isOn));
  for (const select of [one, other, gain]) {
    select.addEventListener("change", () => {
      select.dataset.chosen = select.value;
      again();
    });
  }
  refill();
}

// As displayed on black, where a picture has no background.
async function pixels(blob) {
  const bitmap = await createImageBitmap(blob, { premultiplyAlpha: "none", colorSpaceConversion: "none" });
  const drawing = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d", { alpha: false });
  drawing.drawImage(bitmap, 0, 0);
  const { width, height } = bitmap;
  bitmap.close();
  return drawing.getImageData(0, 0, width, height);
}

// `largest`, with `at` its pixel, and `mean` in steps of 255 over all channels; `share` of the pixels that differ at all.
export function difference(one, other, gain) {
  const image = new ImageData(one.width, one.height);
  let [largest, at, sum, differing] = [0, 0, 0, 0];
  for (let i = 0; i < one.data.length; i += 4) {
    let most = 0;
    for (let channel = i; channel < i + 3; channel++) {
      const apart = Math.abs(one.data[channel] - other.data[channel]);
      image.data[channel] = apart * gain; // clamped
      sum += apart;
      if (apart > most) most = apart;
    }
    image.data[i + 3] = 255;
    if (most) differing++;
    if (most > largest) [largest, at] = [most, i / 4];
  }
  const count = one.width * one.height;
  return { image, largest, at: [at % one.width, Math.floor(at / one.width)], mean: sum / (3 * count), share: differing / count };
}

function inWords({ largest, at, mean, share }) {
  if (!largest) return "No pixel differs.";
  const percent = Number((100 * share).toPrecision(2));
  return `Largest ${largest} of 255, at (${at.join(", ")}); mean ${Number(mean.toPrecision(2))}; ${percent} % of the pixels differ.`;
}
