// The object: a built-in one with as many faces as asked for, or a mesh file, chosen or dropped anywhere on the page.
import { Scale } from "./numbers.js";
import { learn, titled } from "./object_names.js";
import { upload } from "./server.js";

export function start(context) {
  for (const [object, name] of Object.entries(context.start.brought)) learn(object, name);
  const chooser = new Chooser(context);
  const file = document.getElementById("object-file");
  document.getElementById("open-object").addEventListener("click", () => file.click());
  file.addEventListener("change", () => {
    if (file.files[0]) chooser.load(file.files[0]);
    file.value = ""; // so that the same file may be chosen again
  });
  dropAnywhere((mesh) => chooser.load(mesh));
}

class Chooser {
  #select = document.getElementById("object");
  #faces = document.getElementById("object-faces");
  #problem = document.getElementById("object-problem");
  #notes = document.getElementById("object-notes");
  #builtIn = new Set([...this.#select.options].map(({ value }) => value));
  #scale = new Scale({ ...this.#faces.dataset, label: "faces", low: 1, high: 1, step: 1, whole: "" });
  #usual = Number(this.#faces.dataset.default);
  #shown = null;

  constructor({ settings, say }) {
    Object.assign(this, { settings, say });
    this.#select.addEventListener("change", () => this.#choose(this.#count));
    this.#faces.addEventListener("change", () => this.#choose(this.#faces.value));
    settings.addEventListener("change", () => this.#show());
    this.#show();
  }

  // Sends a file to the server, which takes it for the object if it can be read.
  async load(mesh) {
    this.#tell("");
    this.#notes.textContent = `Reading ${mesh.name} …`;
    try {
      const { object, faces, vertices, notes } = await upload(`object?name=${encodeURIComponent(mesh.name)}`, mesh);
      learn(object, mesh.name);
      this.settings.set("object", object);
      const counts = `${mesh.name}: ${faces.toLocaleString("en")} faces, ${vertices.toLocaleString("en")} vertices.`;
      this.#notes.textContent = [counts, ...notes].join(" ");
    } catch (error) {
      this.#notes.textContent = "";
      this.#tell(error.message);
      this.say("error", error.message);
    }
  }

  // Of the object as it is, whatever was typed and not taken.
  get #count() {
    const [shape, count] = this.settings.value("object").split(":");
    return (this.#builtIn.has(shape) && count) || "";
  }

  #choose(count) {
    const name = this.#select.value;
    if (!this.#builtIn.has(name)) return this.settings.set("object", name);
    const { value, problem } = count ? this.#scale.read(count) : { value: this.#usual };
    this.#tell(problem ?? "");
    if (!problem) this.settings.set("object", value === this.#usual ? name : `${name}:${value}`);
  }

  #show() {
    const object = this.settings.value("object");
    const [shape] = object.split(":");
    const isBuiltIn = this.#builtIn.has(shape);
    const title = titled(object);
    this.#offer(isBuiltIn ? shape : object, isBuiltIn ? shape : title);
    this.#select.value = isBuiltIn ? shape : object;
    this.#faces.disabled = !isBuiltIn;
    if (object !== this.#shown || document.activeElement !== this.#faces) {
      this.#faces.value = isBuiltIn ? this.#count || this.#usual : "";
      this.#tell("");
    }
    this.#shown = object;
    document.getElementById("object-name").textContent = title;
    document.title = `${title} – fakesss tune`;
  }

  #offer(object, title) {
    const option = [...this.#select.options].find(({ value }) => value === object) ?? new Option("", object);
    option.text = title;
    if (!option.parentElement) this.#select.add(option);
  }

  #tell(sentence) {
    this.#problem.textContent = sentence;
    this.#problem.hidden = !sentence;
    this.#faces.setAttribute("aria-invalid", Boolean(sentence));
  }
}

function dropAnywhere(load) {
  const sign = document.getElementById("drop");
  let depth = 0; // a drag enters an element before it leaves the one around it
  const on = (kind, act) =>
    addEventListener(kind, (event) => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault(); // or the browser would leave the page for the file
      act(event);
      sign.hidden = depth === 0;
    });
  on("dragenter", () => depth++);
  on("dragleave", () => depth--);
  on("dragover", () => {});
  on("drop", ({ dataTransfer }) => {
    depth = 0;
    if (dataTransfer.files[0]) load(dataTransfer.files[0]);
  });
}
