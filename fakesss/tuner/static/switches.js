// What moves by itself and what is laid over the picture: switches of the panel for animate.js and overlay.js.
import { HOME } from "./gestures.js";
import { Scale, written } from "./numbers.js";

const SPEED = { label: "speed", low: -180, high: 180, step: 1, least: -720, most: 720 }; // degrees a second

export function start({ settings, animation, overlay }) {
  const turning = document.getElementById("auto-rotation");
  const wandering = document.getElementById("random-lighting");
  const speed = document.getElementById("rotation-speed");
  const problem = document.getElementById("speed-problem");

  turning.addEventListener("change", () => animation.turn(turning.checked));
  wandering.addEventListener("change", () => animation.wander(wandering.checked));
  animation.addEventListener("change", () => {
    turning.checked = animation.turning;
    wandering.checked = animation.wandering;
  });
  speed.addEventListener("change", () => {
    const read = new Scale(SPEED).read(speed.value);
    problem.textContent = read.problem ?? "";
    problem.hidden = !read.problem;
    if (!read.problem) animation.speed = read.value;
  });
  speed.value = written(animation.speed);
  document.getElementById("reset-camera").addEventListener("click", () => settings.reset(...HOME));
  for (const name of ["box", "axes"]) {
    const shown = document.getElementById(`show-${name}`);
    shown.addEventListener("change", () => (overlay[name] = shown.checked));
  }
}
