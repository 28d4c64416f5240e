// What the Shader panel tells of the program itself: where the shaders are, and every value there is.
import { post } from "./server.js";

export function start({ settings, say, start: { base, shaders } }) {
  const values = document.getElementById("values");
  document.getElementById("shader-folder").textContent = shaders;
  document.getElementById("reload-shaders").addEventListener("click", async () => {
    try {
      await post("reload", {}); // then the server asks every viewer to look again
    } catch (error) {
      say("error", error.message);
    }
  });
  document.getElementById("print-values").addEventListener("click", () => {
    const { effects } = settings.current;
    const fields = [...paths({ ...base, lights: settings.value("lights") })];
    const lines = fields.map((path) => `${path} = ${JSON.stringify(settings.value(path))}`);
    const switched = Object.entries(effects).map(([name, state]) => `effect ${name}: ${state}`);
    values.textContent = [...lines, ...switched].join("\n");
    values.hidden = false;
    values.focus();
  });
}

// Of every field within a table or a list of tables: "material.backlight", "lights.0.azimuth".
function* paths(table, before = "") {
  for (const [name, value] of Object.entries(table)) {
    const isTable = value !== null && typeof value === "object" && !Array.isArray(value);
    const isTables = Array.isArray(value) && value.every((each) => typeof each === "object");
    if (isTable || isTables) yield* paths(value, `${before}${name}.`);
    else yield `${before}${name}`;
  }
}
