// What the Shader panel tells of the program itself: where the shaders are, and every value as a scene file.
import { postForFile } from "./server.js";

export function start({ settings, say, stage, start: { shaders } }) {
  const values = document.getElementById("values");
  document.getElementById("shader-folder").textContent = shaders;
  document.getElementById("reload-shaders").addEventListener("click", () => {
    stage.redraw();
    say("info", "Drawn again with the shaders as they are now.");
  });
  document.getElementById("print-values").addEventListener("click", async () => {
    try {
      const file = await postForFile("scene.toml", { settings: settings.current });
      values.textContent = await file.text();
      values.hidden = false;
      values.focus();
    } catch (error) {
      say("error", error.message);
    }
  });
}
