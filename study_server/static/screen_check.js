// One check of the screen after the other; the last one, or the participant's wish to do without, sends the form.
// Nothing is compulsory: what was not touched is not sent.
import { card } from "/static/screen_card.js";
import { screenFacts } from "/static/screen.js";
import { keep, restored } from "/static/screen_place.js";
import { match, wedge } from "/static/screen_wedge.js";

const form = document.getElementById("checks");
const count = document.getElementById("count");
const checks = [...form.querySelectorAll(".check")];
let at = 0;

window.addEventListener("pageshow", (event) => event.persisted && location.reload());  // back: the server knows where
for (const stepper of form.querySelectorAll(".stepper")) withButtons(stepper);
for (const canvas of form.querySelectorAll(".wedge")) wedge(canvas);
for (const canvas of form.querySelectorAll(".match")) match(canvas, canvas.closest(".matches > div").querySelector("input"));
for (const slider of form.querySelectorAll(".matches input")) {
  slider.addEventListener("input", () => (slider.name = slider.dataset.name));  // unnamed it is not sent
}
const size = document.getElementById("card") && card(document.getElementById("card"));

form.addEventListener("click", pressed);
form.addEventListener("keydown", entered);
form.addEventListener("input", typed);
form.addEventListener("submit", () => fill(facts()));
const first = restored(form);
show(first < checks.length ? first : 0);

// Check number `index`; past the last one the form is sent.
function show(index) {
  if (index >= checks.length) return form.requestSubmit();
  at = index;
  checks.forEach((check, i) => (check.hidden = i !== at));
  document.getElementById("why").hidden = at > 0;
  keep(form, at);
  count.textContent = count.dataset.words.replace("{n}", at + 1).replace("{total}", checks.length);
}

function go(by) {
  show(at + by);
  if (!checks[at].hidden) checks[at].querySelector("h2").focus();  // read out, and the next Tab is in the new check
  scrollTo(0, 0);
}

function pressed(event) {
  const button = event.target.closest("button");
  if (button?.hasAttribute("data-back")) go(-1);
  if (!button?.hasAttribute("data-next")) return;
  if (checks[at].id === "card") fill(size(button.dataset.card));
  if (button.hasAttribute("data-nothing")) nothing(true);
  go(1);
}

// The Enter key in a field is its check's button, never the form's, which would leave all the others out.
function entered(event) {
  if (event.key !== "Enter" || !event.target.matches("input")) return;
  event.preventDefault();
  checks[at].querySelector("[data-next]").click();
}

function typed(event) {
  if (event.target.matches(".answer input")) nothing(false);
  if (event.target.type === "range") event.target.dataset.moved = "yes";
  if (event.isTrusted || event.target.type === "range") keep(form, at);
}

// "I see no number" is an answer: the hidden field of the same name is sent after what is typed, and counts.
function nothing(seen) {
  const [answer, word] = checks[at].querySelectorAll(".answer input");
  word.disabled = !seen;
  if (seen) answer.value = "";
}

function withButtons(stepper) {
  const slider = stepper.querySelector("input");
  stepper.addEventListener("click", (event) => {
    const by = event.target.dataset.by;
    if (!by) return;
    slider.value = Number(slider.value) + Number(by);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
}

function fill(values) {
  for (const [name, value] of Object.entries(values)) form.elements[name].value = value;
}

// What the browser knows of the screen without asking anybody.
function facts() {
  const { window_width_px, window_height_px, device_pixel_ratio, zoom, gamut } = screenFacts();
  const dynamic_range_high = Number(matchMedia("(dynamic-range: high)").matches);
  const { width: width_px, height: height_px, colorDepth: color_depth } = screen;
  const sizes = { width_px, height_px, window_width_px, window_height_px };
  return { ...sizes, device_pixel_ratio, zoom, color_depth, gamut, dynamic_range_high };
}
