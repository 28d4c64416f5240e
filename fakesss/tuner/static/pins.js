// Up to four settings side by side. A click brings one back; 1 to 4 held show it at full size on the stage.
import { differing, inWords } from "./differing.js";
import { Peek } from "./peek.js";
import { setPressable } from "./pressable.js";

const MOST = 4;
const KEY = `fakesss-pins ${location.pathname}`; // kept while this tab is open: a reload loses none

export class Pins extends EventTarget {
  #count = 0; // of all that ever were
  #pins = []; // {id, name, settings, view, entry: its element, index: its place, peek: its key, asked: its newest picture}
  #list = document.getElementById("pins");
  #button = document.getElementById("pin");

  constructor(context, pictures) {
    super();
    Object.assign(this, { context, pictures });
    this.#button.addEventListener("click", () => this.#pinned());
    context.settings.addEventListener("change", ({ detail }) => detail.moving || this.#tell());
    context.connection.addEventListener("message", ({ detail }) => detail.shaders && this.#renew());
    for (const kept of restored()) this.#restored(kept);
    this.#tell();
  }

  // [{id, name, settings, view}], as they stand.
  get all() {
    return this.#pins.map(({ id, name, settings, view }, place) => ({ id, name: name || `pin ${place + 1}`, settings, view }));
  }

  async #pinned() {
    if (this.#pins.length === MOST) return;
    const { settings, stage } = this.context;
    const pin = this.#add({ name: "", settings: settings.current, view: stage.view });
    this.#keep();
    try {
      await this.#draw(pin);
    } catch (error) {
      this.#remove(pin);
      this.context.say("error", `This cannot be pinned: ${error.message}`);
    }
  }

  // It stays without a picture too: the server may be busy, or a shader be wrong that will be mended.
  async #restored(kept) {
    const pin = this.#add(kept);
    try {
      await this.#draw(pin);
    } catch (error) {
      this.context.say("error", `A pin's picture could not be drawn: ${error.message}`);
    }
  }

  #add(pin) {
    const entry = document.getElementById("pin-entry").content.firstElementChild.cloneNode(true);
    this.#pins.push(Object.assign(pin, { entry, id: `pin-${++this.#count}` }));
    this.#list.append(entry);
    this.#wire(pin);
    this.#tell();
    return pin;
  }

  async #draw(pin) {
    const asked = (pin.asked = Symbol());
    const blob = await this.pictures.of(pin.settings, pin.view);
    if (asked !== pin.asked || !this.#pins.includes(pin)) return; // drawn with the shaders before, or removed meanwhile
    const image = pin.entry.querySelector("img");
    URL.revokeObjectURL(image.src);
    image.src = URL.createObjectURL(blob);
  }

  // By other shaders. If they are wrong the last good pictures stay, which the stage says of its own.
  async #renew() {
    await Promise.allSettled(this.#pins.map((pin) => this.#draw(pin)));
  }

  #wire(pin) {
    const { entry } = pin;
    const { settings, stage } = this.context;
    const name = entry.querySelector(".pin-name");
    name.value = pin.name;
    entry.querySelector(".restore").addEventListener("click", () => {
      if (stage.view !== pin.view) stage.view = pin.view;
      settings.replace(pin.settings);
    });
    entry.querySelector(".remove").addEventListener("click", () => {
      this.#remove(pin);
      (this.#list.querySelector(".remove") ?? this.#button).focus();
    });
    name.addEventListener("change", () => {
      pin.name = name.value.trim();
      this.#keep();
      this.#tell();
    });
  }

  #remove(pin) {
    pin.peek?.leave.abort();
    this.context.stage.showLive(); // if it was looked at
    URL.revokeObjectURL(pin.entry.querySelector("img").src);
    pin.entry.remove();
    this.#pins = this.#pins.filter((one) => one !== pin);
    this.#keep();
    this.#tell();
  }

  // What each has that others, or the live picture, have not.
  #tell() {
    const { settings } = this.context;
    const values = differing(settings, [settings.current, ...this.#pins.map((pin) => pin.settings)]);
    this.all.forEach(({ name }, index) => {
      const pin = this.#pins[index];
      const { entry } = pin;
      const words = [pin.view === "picture" ? "" : pin.view.replaceAll("_", " "), inWords(values, pin.settings)];
      const told = words.filter(Boolean).join(": ") || "as the live picture";
      entry.querySelector(".number").textContent = index + 1;
      entry.querySelector(".values").textContent = entry.querySelector(".values").title = told;
      entry.querySelector(".restore").setAttribute("aria-label", `Bring back ${name}: ${told}`);
      entry.querySelector(".remove").setAttribute("aria-label", `Remove ${name}`);
      entry.querySelector(".look").setAttribute("aria-label", `Look at ${name}`);
      entry.querySelector(".pin-name").setAttribute("aria-label", `Name of pin ${index + 1}`);
      entry.querySelector(".pin-name").placeholder = `pin ${index + 1}`;
      this.#listen(pin, index, `${name}: ${told}`);
    });
    setPressable(this.#button, this.#pins.length < MOST);
    document.getElementById("compare").hidden = this.#pins.length === 0;
    this.dispatchEvent(new CustomEvent("change"));
  }

  // Its key is its place in the row.
  #listen(pin, index, caption) {
    pin.caption = caption;
    if (pin.index === index) return;
    pin.peek?.leave.abort();
    const look = pin.entry.querySelector(".look");
    pin.index = index;
    pin.peek = new Peek(this.context, this.pictures, look, String(index + 1), () => pin);
  }

  #keep() {
    try {
      sessionStorage.setItem(KEY, JSON.stringify(this.#pins.map(({ name, settings, view }) => ({ name, settings, view }))));
    } catch {
      // storage is blocked
    }
  }
}

function restored() {
  try {
    return JSON.parse(sessionStorage.getItem(KEY)) ?? [];
  } catch {
    return []; // blocked
  }
}
