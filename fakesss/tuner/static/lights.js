// Which of the lights the panel shows and a right drag moves, and how lights are added and taken away.

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

export function start({ settings, say }) {
  const chips = document.getElementById("lights");
  const template = document.getElementById("light-chip");
  const add = document.getElementById("add-light");
  const remove = document.getElementById("remove-light");

  function show() {
    const further = settings.value("lights").length;
    if (picked.index > further) picked.pick(further); // it was taken away, by undo too
    while (chips.children.length > further + 1) chips.lastElementChild.remove();
    while (chips.children.length < further + 1) chips.append(chip(chips.children.length));
    chips.children[picked.index].querySelector("input").checked = true;
    add.disabled = further + 1 >= MOST;
    remove.disabled = picked.index === 0;
  }

  function chip(index) {
    const made = template.content.cloneNode(true);
    const button = made.querySelector("input");
    button.value = index;
    button.setAttribute("aria-label", index ? `Light ${index + 1}` : "Main light");
    button.addEventListener("change", () => picked.pick(index));
    made.querySelector("span").textContent = index ? index + 1 : "Main";
    return made;
  }

  // A copy of the picked light from another side, without its ambient light: that would be counted twice.
  add.addEventListener("click", () => {
    const lights = settings.value("lights");
    const like = picked.index ? lights[picked.index - 1] : settings.value("light");
    const azimuth = ((like.azimuth + APART + 180) % 360) - 180;
    settings.set("lights", [...lights, { ...like, azimuth, ambient: [0, 0, 0] }]);
    picked.pick(lights.length + 1);
  });

  remove.addEventListener("click", () => {
    const { index } = picked;
    picked.pick(index - 1);
    settings.set("lights", settings.value("lights").toSpliced(index - 1, 1));
    say("info", `Light ${index + 1} is removed; undo brings it back.`);
    chips.children[index - 1].querySelector("input").focus();
  });

  settings.addEventListener("change", show);
  picked.addEventListener("pick", show);
  show();
}
