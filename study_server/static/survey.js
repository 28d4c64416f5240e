// One trial after another: shows the picture that the server says is due, times and sends the answers, and goes on
// when the server has them on disk. The server holds the position; this page only follows it.
import { Damaged, picture } from "/static/pictures.js";
import { Stopwatch, display, fitToPixels } from "/static/screen.js";
import { post, state as fetchState } from "/static/sending.js";

const form = document.getElementById("trial");
const stage = document.getElementById("stage");
const next = document.getElementById("next");
const saved = document.getElementById("saved");
const questions = [...form.querySelectorAll(".question")];
const watch = new Stopwatch();
const firstStep = document.body.className;

let trial = null;  // the server's dict of the trial on screen; null while there is none to answer
let rtMs = [];

window.addEventListener("pageshow", (event) => event.persisted && location.reload());  // back: the server knows where
window.addEventListener("resize", () => fitToPixels(stage.querySelector("img")));
form.addEventListener("change", chosen);
form.addEventListener("submit", submit);
document.addEventListener("keydown", digit);
follow(await fetchState(form.dataset.here, say));

// Go where the server says. A step that is not of this page is a page of its own.
async function follow(state) {
  if (state.step !== firstStep) return location.replace(form.dataset.here);
  document.getElementById("count").textContent = `${state.practice ? "Practice " : ""}${state.trial} of ${state.trials}`;
  document.getElementById("progress").value = state.trial - 1;
  stage.style.minHeight = `${state.picture.height / devicePixelRatio}px`;  // words take the picture's place
  const image = await undamaged(state.picture);
  for (const radio of form.querySelectorAll("input")) radio.checked = false;
  rtMs = questions.map(() => null);
  stage.replaceChildren(image);
  stage.style.minHeight = "";
  fitToPixels(image);
  await watch.start();
  trial = { ...state, submission: newName(), sha256: image.dataset.sha256 };
  for (const question of questions) question.disabled = false;
  next.disabled = false;
  refreshNext();
  focusOn(0);
  for (const next of state.ahead) picture(next.picture).catch(() => {});  // asked for again when it is due
}

// The picture, however long it takes; a picture that is not exactly the right one is never shown.
async function undamaged(facts) {
  for (let attempt = 1; ; attempt++) {
    try {
      return await picture(facts);
    } catch (error) {
      const what = error instanceof Damaged ? "The picture did not arrive as it was made" : "The picture could not be loaded";
      const words = Object.assign(document.createElement("p"), { id: "waiting" });
      words.setAttribute("role", "alert");
      words.textContent = `${what}, so it is not shown. Trying again …`;
      if (attempt > 4) words.textContent += " If this goes on, please tell the person who invited you; nothing is lost.";
      stage.replaceChildren(words);
      await new Promise((resolve) => setTimeout(resolve, Math.min(500 * 2 ** attempt, 10_000)));
    }
  }
}

function chosen(event) {
  const index = questions.indexOf(event.target.closest(".question"));
  rtMs[index] = watch.elapsed();
  refreshNext();
}

// Keys 1-9 and 0 for ten answer the question that has the focus, else the first open one; the focus moves on.
function digit(event) {
  if (!trial || event.ctrlKey || event.metaKey || event.altKey || !/^[0-9]$/.test(event.key)) return;
  const focused = questions.findIndex((question) => question.contains(document.activeElement));
  const index = focused >= 0 ? focused : rtMs.indexOf(null);
  const radio = index < 0 ? null : questions[index].querySelector(`input[value="${Number(event.key) || 10}"]`);
  if (!radio) return;
  event.preventDefault();
  radio.checked = true;
  radio.dispatchEvent(new Event("change", { bubbles: true }));
  focusOn(index + 1);
}

// Focus on a question's answer, or its first step; past the last question on Next.
function focusOn(index) {
  const question = questions[index];
  const target = question ? (question.querySelector("input:checked") ?? question.querySelector("input")) : next;
  target.focus({ preventScroll: index === 0 });
}

function refreshNext() {
  next.setAttribute("aria-disabled", rtMs.includes(null));
}

async function submit(event) {
  event.preventDefault();
  if (!trial) return;  // a second click while the first one is being saved, or before the picture is there
  const open = rtMs.indexOf(null);
  if (open >= 0) {
    if (rtMs.some((ms) => ms !== null)) say("Please answer every question.");
    return focusOn(open);
  }
  const answered = trial;
  trial = null;
  next.setAttribute("aria-disabled", true);
  say("Saving …");
  const reply = await post(form.dataset.here, () => filledIn(answered), say);
  say(reply.error ?? "Saved", Boolean(reply.error));
  for (const question of questions) question.disabled = true;
  await follow(reply.next ?? (await fetchState(form.dataset.here, say)));
}

// What is sent: made anew for every attempt, since time goes on; the submission's name stays.
function filledIn(answered) {
  const answers = questions.map((question, i) => ({
    question: question.dataset.name,
    rating: Number(question.querySelector("input:checked").value),
    rt_ms: rtMs[i],
  }));
  return {
    place: answered.place,
    submission: answered.submission,
    stimulus_sha256: answered.sha256,
    since_shown_ms: watch.elapsed(),
    answers,
    display: { ...display(stage.querySelector("img")), focus_lost_ms: watch.lost() },
  };
}

function newName() {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

function say(words, trouble = false) {
  saved.textContent = words;
  saved.className = trouble ? "trouble" : "";
}
