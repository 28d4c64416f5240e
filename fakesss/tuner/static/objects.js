// The object: a built-in one with as many faces as asked for, or a mesh file, chosen or dropped anywhere on the page.
import { Scale, written } from "./numbers.js";
import { upload } from "./server.js";

export function start({ settings, say }) {
  const select = document.getElementById("object");
  const faces = document.getElementById("object-faces");
  const file = document.getElementById("object-file");
  const problem = document.getElementById("object-problem");
  const notes = document.getElementById("object-notes");
  const builtIn = new Set([...select.options].map(({ value }) => value));
  const scale = new Scale({ ...faces.dataset, label: "faces", low: 1, high: 1, step: 1, whole: "" });
  const usual = Number(faces.dataset.default);

  function show() {
    const object = settings.value("object");
    const [name, count] = shapeOf(object, builtIn) ?? [object, ""];
    if (![...select.options].some(({ value }) => value === name)) select.add(new Option(fileName(name), name));
    select.value = name;
    faces.disabled = !builtIn.has(name);
    if (document.activeElement !== faces) faces.value = builtIn.has(name) ? written(count ?? usual) : "";
    document.getElementById("object-name").textContent = builtIn.has(name) ? object : fileName(name);
    document.title = `${document.getElementById("object-name").textContent} – fakesss tune`;
  }

  function tell(sentence) {
    problem.textContent = sentence;
    problem.hidden = !sentence;
    faces.setAttribute("aria-invalid", Boolean(sentence));
  }

  function choose() {
    const name = select.value;
    if (!builtIn.has(name)) return settings.set("object", name);
    const read = faces.value ? scale.read(faces.value) : { value: usual };
    tell(read.problem ?? "");
    if (!read.problem) settings.set("object", read.value === usual ? name : `${name}:${read.value}`);
  }

  async function load(mesh) {
    tell("");
    notes.textContent = `Reading ${mesh.name} …`;
    try {
      const found = await upload(`object?name=${encodeURIComponent(mesh.name)}`, mesh);
      select.add(new Option(mesh.name, found.object));
      settings.set("object", found.object);
      notes.textContent = [`${mesh.name}: ${written(found.faces)} faces, ${written(found.vertices)} vertices.`, ...found.notes].join(" ");
    } catch (error) {
      notes.textContent = "";
      tell(error.message);
      say("error", error.message);
    }
  }

  select.addEventListener("change", choose);
  faces.addEventListener("change", choose);
  document.getElementById("open-object").addEventListener("click", () => file.click());
  file.addEventListener("change", () => {
    if (file.files[0]) load(file.files[0]);
    file.value = ""; // so that the same file may be chosen again
  });
  dropAnywhere(load);
  settings.addEventListener("change", show);
  show();
}

// "knot:60000" as ["knot", 60000], "knot" as ["knot"]; null for a file.
function shapeOf(object, builtIn) {
  const [name, count] = object.split(":");
  if (!builtIn.has(name)) return null;
  return count === undefined ? [name] : [name, Number(count)];
}

function fileName(path) {
  return path.split(/[\\/]/).at(-1);
}

function dropAnywhere(load) {
  const sign = document.getElementById("drop");
  let depth = 0; // a drag enters an element before it leaves the one around it
  const holdsFile = (event) => event.dataTransfer?.types.includes("Files");
  const on = (kind, act) =>
    addEventListener(kind, (event) => {
      if (!holdsFile(event)) return;
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
