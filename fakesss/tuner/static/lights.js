// Which of the lights the panel shows and a right drag moves, and how lights are added and taken away.
import { wrapped } from "./numbers.js";

const MOST = 32; // fakesss.lights.MOST_LIGHTS
const APART = 60; // degrees from the light that a new one is a copy of

class Picked extends EventTarget {
  index = 0; // 0: the main light; n: the n-th further one

  // The scene path that stands for one of the main light: "lights.1.azimuth" for "light.azimuth". Others are left alone.
  path(path) {
    return this.index && path.startsWith("light.") ? path.replace("light.", `lights.${this.index - 1}.`) : path;
  }

  pick(index) {
    if (index === this.index) return;
    this.index = index;
    this.dispatchEvent(new Event("pick"));
  }
}

export const picked = new Picked();

export function start({ settings, stage, say }) {
  const chips = new Chips();
  const add = document.getElementById("add-light");
  const remove = document.getElementById("remove-light");

  const show = () => {
    const further = settings.value("lights").length;
    if (picked.index > further) picked.pick(further); // it was taken away, by undo too
    chips.show(further + 1, picked.index);
    add.disabled = further + 1 >= MOST;
    remove.disabled = picked.index === 0;
  };

  add.addEventListener("click", () => {
    const lights = settings.value("lights");
    settings.set("lights", [...lights, another(picked.index ? lights[picked.index - 1] : mainLight(settings))]);
    picked.pick(lights.length + 1);
  });
  remove.addEventListener("click", () => {
    const { index } = picked;
    picked.pick(index - 1);
    settings.removeLight(index - 1);
    say("info", `Light ${index + 1} is removed; undo brings it back.`);
    chips.focus(index - 1);
  });
  settings.addEventListener("change", show);
  picked.addEventListener("pick", () => {
    stage.light = picked.index;
    show();
  });
  show();
}

// With what was changed of it.
function mainLight(settings) {
  const fields = Object.keys(settings.original("light"));
  return Object.fromEntries(fields.map((field) => [field, settings.value(`light.${field}`)]));
}

// The same light from another side, without its ambient light: that would be counted twice.
function another(light) {
  return { ...light, azimuth: wrapped(light.azimuth + APART), ambient: [0, 0, 0] };
}

// One radio button for each light.
class Chips {
  #place = document.getElementById("lights");
  #template = document.getElementById("light-chip");

  show(count, chosen) {
    const { children } = this.#place;
    while (children.length > count) this.#place.lastElementChild.remove();
    while (children.length < count) this.#place.append(this.#chip(children.length));
    children[chosen].querySelector("input").checked = true;
  }

  focus(index) {
    this.#place.children[index].querySelector("input").focus();
  }

  #chip(index) {
    const made = this.#template.content.cloneNode(true);
    const button = made.querySelector("input");
    button.setAttribute("aria-label", index ? `Light ${index + 1}` : "Main light");
    button.addEventListener("change", () => picked.pick(index));
    made.querySelector("span").textContent = index ? index + 1 : "Main";
    return made;
  }
}
