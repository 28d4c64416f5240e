// The pictures of a sweep: the settings of each, and their small pictures, drawn one after the other.
import { postForFile } from "./server.js";

const KEPT = 200; // small pictures

// Scene fields that an effect switched by hand sets, whatever the settings' changes say (fakesss.tuner.wishes.OFF).
const SET_BY_EFFECT = {
  backlight: "material.backlight",
  blur: "blur.enabled",
  occlusion: "occlusion.enabled",
  diffuse: "material.diffuse_contribution",
  specular: "material.specular_contribution",
};

// Every combination of levels in the order of a study, the last factor varying fastest: [{levels: [[path, level], ...],
// name, settings}]. `factors` as FactorForm has them, `current` the settings around which they vary.
export function combinations(factors, settings, current) {
  let found = [{ levels: [], words: [] }];
  for (const { name, path, levels, labels } of factors) {
    found = found.flatMap((before) =>
      levels.map((level, index) => ({
        levels: [...before.levels, [path, level]],
        words: [...before.words, `${name} ${labels[index]}`],
      })),
    );
  }
  return found.map(({ levels, words }) => {
    const next = levels.reduce((made, [path, level]) => withLevel(settings, made, path, level), current);
    return { levels, name: words.join(", "), settings: next };
  });
}

// `current` with one field at a level, as a study sets it: an effect switched by hand gives way.
function withLevel(settings, current, path, level) {
  const next = structuredClone(current);
  for (const [effect, field] of Object.entries(SET_BY_EFFECT)) if (field === path) delete next.effects[effect];
  if (path.endsWith(".shadows") && "shadows" in next.effects) {
    const isOn = next.effects.shadows === "on";
    delete next.effects.shadows;
    put(settings, next, "light.shadows", isOn);
    for (const index of settings.valueIn(next, "lights").keys()) put(settings, next, `lights.${index}.shadows`, isOn);
  }
  put(settings, next, path, level);
  return next;
}

// The value that the picture is drawn with now: an effect switched by hand goes before what the panel says.
export function drawn(settings, path) {
  const found = Object.entries(SET_BY_EFFECT).find(([, field]) => field === path);
  const state = settings.effect(found ? found[0] : path.endsWith(".shadows") ? "shadows" : "");
  const value = settings.value(path);
  if (state === "auto") return value;
  if (typeof value === "boolean") return state === "on";
  return state === "off" ? 0 : value;
}

function put(settings, next, path, value) {
  const [first, index, field] = path.split(".");
  if (first !== "lights") next.changes[path] = value;
  else next.changes.lights = settings.valueIn(next, "lights").with(index, { ...settings.valueIn(next, `lights.${index}`), [field]: value });
}

// Small pictures as they are asked for; those asked for lately are kept.
export class SmallPictures {
  #kept = new Map(); // what was asked -> {address, bytes}
  #abort = new AbortController();

  // Calls `drawn(cell, {address, bytes})` or `failed(cell, problem)` for each cell in turn; true when all were tried, false
  // if `stop` came first. What is kept comes at once.
  async draw(cells, size, drawn, failed) {
    this.stop();
    const { signal } = (this.#abort = new AbortController());
    const missing = cells.filter((cell) => {
      const kept = this.#kept.get(key(cell, size));
      if (kept) drawn(cell, kept);
      return !kept;
    });
    for (const cell of missing) {
      try {
        const blob = await postForFile("picture", { settings: cell.settings, size }, signal);
        const bytes = new Uint8Array(await blob.arrayBuffer());
        if (signal.aborted) return false;
        drawn(cell, this.#keep(key(cell, size), { address: URL.createObjectURL(blob), bytes }));
      } catch (problem) {
        if (signal.aborted) return false;
        failed(cell, problem.message);
      }
    }
    return true;
  }

  // The shaders may have changed: what is kept is of no use.
  forget() {
    this.stop();
    for (const { address } of this.#kept.values()) URL.revokeObjectURL(address);
    this.#kept.clear();
  }

  stop() {
    this.#abort.abort();
  }

  #keep(asked, picture) {
    this.#kept.set(asked, picture);
    const [oldest] = this.#kept.keys();
    if (this.#kept.size > KEPT) {
      URL.revokeObjectURL(this.#kept.get(oldest).address);
      this.#kept.delete(oldest);
    }
    return picture;
  }
}

function key({ settings }, size) {
  return JSON.stringify([settings, size]);
}

// Cells whose pictures are the same as an earlier one's, each with that: [[cell, earlier], ...].
export function alike(pictures) {
  const found = [];
  const seen = [];
  for (const [cell, { bytes }] of pictures) {
    const earlier = seen.find((other) => isEqual(other.bytes, bytes));
    if (earlier) found.push([cell, earlier.cell]);
    else seen.push({ cell, bytes });
  }
  return found;
}

function isEqual(one, other) {
  return one.length === other.length && one.every((byte, index) => byte === other[index]);
}
