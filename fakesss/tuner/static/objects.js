// The object: a built-in one with as many faces as asked for, or a mesh file, chosen or dropped anywhere on the page.
import { Scale, written } from "./numbers.js";
import { upload } from "./server.js";

export function start(context) {
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

  constructor({ settings, say }) {
    Object.assign(this, { settings, say });
    this.#select.addEventListener("change", () => this.#choose());
    this.#faces.addEventListener("change", () => this.#choose());
    settings.addEventListener("change", () => this.#show());
    this.#show();
  }

  // Sends a file to the server, which takes it for the object if it can be read.
  async load(mesh) {
    this.#tell("");
    this.#notes.textContent = `Reading ${mesh.name} …`;
    try {
      const { object, faces, vertices, notes } = await upload(`object?name=${encodeURIComponent(mesh.name)}`, mesh);
      this.#offer(object, mesh.name);
      this.settings.set("object", object);
      const counts = `${mesh.name}: ${faces.toLocaleString("en")} faces, ${vertices.toLocaleString("en")} vertices.`;
      this.#notes.textContent = [counts, ...notes].join(" ");
    } catch (error) {
      this.#notes.textContent = "";
      this.#tell(error.message);
      this.say("error", error.message);
    }
  }

  #choose() {
    const name = this.#select.value;
    if (!this.#builtIn.has(name)) return this.settings.set("object", name);
    const { value, problem } = this.#faces.value ? this.#scale.read(this.#faces.value) : { value: this.#usual };
    this.#tell(problem ?? "");
    if (!problem) this.settings.set("object", value === this.#usual ? name : `${name}:${value}`);
  }

  #show() {
    const object = this.settings.value("object");
    const [shape, count] = object.split(":");
    const isBuiltIn = this.#builtIn.has(shape);
    const title = isBuiltIn ? object : fileName(object);
    this.#offer(isBuiltIn ? shape : object, isBuiltIn ? shape : title);
    this.#select.value = isBuiltIn ? shape : object;
    this.#faces.disabled = !isBuiltIn;
    if (document.activeElement !== this.#faces) this.#faces.value = isBuiltIn ? (count ?? this.#usual) : "";
    const heading = document.getElementById("object-name");
    if (heading.textContent === title) return;
    heading.textContent = title;
    document.title = `${title} – fakesss tune`;
  }

  #offer(object, title) {
    if (![...this.#select.options].some(({ value }) => value === object)) this.#select.add(new Option(title, object));
  }

  #tell(sentence) {
    this.#problem.textContent = sentence;
    this.#problem.hidden = !sentence;
    this.#faces.setAttribute("aria-invalid", Boolean(sentence));
  }
}

function fileName(path) {
  return path.split(/[\\/]/).at(-1);
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
