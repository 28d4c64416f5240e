// Measured media as starting points for the material.
import { Scale, written } from "./numbers.js";
import { post } from "./server.js";

const SIZE = { label: "size", low: 1, high: 1000, step: 1, least: 0, above: "", most: 1e6 }; // millimetres

export function start({ settings, say, start: { media } }) {
  const form = document.getElementById("media");
  const medium = document.getElementById("medium");
  const size = document.getElementById("medium-size");
  const problem = document.getElementById("medium-problem");

  function show() {
    const { sigma_s_prime: scattering, sigma_a: absorption } = media[medium.value];
    const triple = (numbers) => numbers.map((number) => written(number)).join(", ");
    document.getElementById("medium-numbers").textContent =
      `Per mm in R, G, B: reduced scattering ${triple(scattering)}; absorption ${triple(absorption)}.`;
  }

  function tell(sentence) {
    problem.textContent = sentence;
    problem.hidden = !sentence;
  }

  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const read = new Scale(SIZE).read(size.value);
    tell(read.problem ?? "");
    if (read.problem) return;
    try {
      const asked = { settings: settings.current, medium: medium.value, size_mm: read.value };
      settings.setMany((await post("medium", asked)).changes);
      say("info", `The material starts from ${medium.value}, ${written(read.value)} mm across.`);
    } catch (error) {
      tell(error.message);
    }
  });
  medium.addEventListener("change", show);
  show();
}
