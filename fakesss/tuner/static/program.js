// What the Shader panel tells of the program itself: where the shaders are, and every value as a scene file.
import { post, postForFile } from "./server.js";

export function start({ settings, say, start: { shaders } }) {
  const values = document.getElementById("values");
  document.getElementById("shader-folder").textContent = shaders;
  document.getElementById("reload-shaders").addEventListener("click", async () => {
    try {
      await post("reload", {}); // then the server asks every viewer to look again
    } catch (error) {
      say("error", error.message);
    }
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
