// One trial after another. The server holds the position; the participant may be a few answers ahead of what it has saved,
// and those are in the outbox.
import { Delivery } from "/static/delivery.js";
import { Outbox, newName } from "/static/outbox.js";
import { keepOnly, picture } from "/static/pictures.js";
import { Questions } from "/static/questions.js";
import { Stopwatch } from "/static/screen.js";
import { askWhere, pause } from "/static/sending.js";
import { earlierShowing, keepShowing } from "/static/showing.js";
import { Stage } from "/static/stage.js";

const LONG_MS = 1_000; // waiting for the server: from here on the page says why nothing happens

const form = document.getElementById("trial");
const next = document.getElementById("next");
const status = document.getElementById("saved");
const words = form.dataset;
const step = document.body.className;

const watch = new Stopwatch();
const stage = new Stage(document.getElementById("stage"), words, (isCovered) => watch.cover(isCovered));
const template = document.getElementById("question");
const questions = new Questions(document.getElementById("questions"), template, next, (at) => watch.elapsed(at));
const outbox = new Outbox(words.here, putElsewhere);
const delivery = new Delivery(words.here, step, outbox, { heard: proceed, refused, lost: leave });

let trial = null; // the server's dict of the trial on screen, or on its way there; null: the answer was given
let isAnswerable = false;
let answeredAt = 0;
let hasAnswered = false; // on this page, or on an earlier one whose answers were still unsaved
let isLeaving = false;
let refusal = "";

window.addEventListener("pageshow", (event) => event.persisted && location.reload()); // back: the server knows where
window.addEventListener("beforeunload", (event) => outbox.isOnlyInMemory && !isLeaving && event.preventDefault());
for (const event of ["pagehide", "visibilitychange"]) window.addEventListener(event, keepTime); // a tab may end unheard
form.addEventListener("submit", submit);
deliver();

// Bring what is in the outbox to the server, then follow it.
async function deliver() {
  const delivered = delivery.run();
  proceed();
  await delivered;
  proceed();
}

function putElsewhere(isGone) {
  if (isGone) delivery.isStale = true;
  if (!trial) deliver();
}

function proceed() {
  if (delivery.page) goOn(delivery.page);
  tell();
}

// Go where the server says, as far as there is nothing to do here. A step that is not of this page is a page of its own.
function goOn(page) {
  if (page.step !== step) return delivery.isRunning ? undefined : leave();
  const isReplaced = page.release !== words.release && !renewedFor().includes(page.release); // it may speak otherwise now
  if (isAnswerable && !isReplaced) fetchAhead(page);
  if (trial) return;
  if (isReplaced) return delivery.isRunning ? undefined : renew(page.release);
  trial = following(page);
  if (trial) show(trial);
  else setTimeout(tell, LONG_MS);
}

// Once the picture that is looked at is there, the next ones; those that fail are asked for again when they are due.
function fetchAhead(page) {
  if (!page?.ahead) return; // not known just now, closed meanwhile, or another release's
  const coming = page.ahead.map((each) => each.picture);
  keepOnly(new Set([trial, page, ...page.ahead].map((each) => each.picture.url)));
  for (const facts of coming) picture(facts).catch(() => {});
}

// The first trial that has no answer, if it may be shown now: it is due, or only so far ahead as the study allows.
function following(page) {
  if (delivery.isStale) return null;
  const answered = new Set(outbox.answers().map(({ place }) => place));
  const first = [page, ...(page.ahead ?? [])].find(({ place }) => !answered.has(place));
  const mayRunAhead = answered.size <= page.unsaved_ahead && !outbox.isOnlyInMemory;
  return first && (first.place === page.place || mayRunAhead) ? first : null;
}

async function show({ picture: facts, questions: asked, trial: number }) {
  const { practice, trials, scaled_pictures } = delivery.page;
  const sentence = practice ? words.practiceCount : words.count;
  document.getElementById("count").textContent = sentence.replace("{trial}", number).replace("{trials}", trials);
  document.getElementById("progress").value = number - 1;
  questions.ask(asked);
  questions.close({ hide: true });
  stage.isShrinkingRefused = scaled_pictures === "refuse";
  trial = { ...trial, sha256: await stage.show(facts), submission: newName() };
  await watch.start(earlierShowing(words.here, trial.place));
  isAnswerable = true;
  keepTime();
  questions.open();
  next.disabled = false;
  questions.focusOnFirst();
  fetchAhead(delivery.page);
}

function submit(event) {
  event.preventDefault();
  if (!isAnswerable || stage.isCovered) return; // a second click, or nothing to be seen
  const open = questions.firstOpen;
  if (open >= 0) {
    if (!questions.isUntouched) say(words.incomplete);
    return questions.focusOn(open);
  }
  outbox.put(filledIn(trial));
  trial = null;
  isAnswerable = false;
  refusal = "";
  answeredAt = performance.now();
  next.setAttribute("aria-disabled", true);
  questions.close({ hide: false });
  deliver();
}

function filledIn({ place, submission, sha256 }) {
  return {
    place,
    submission,
    stimulus_sha256: sha256,
    since_shown_ms: watch.elapsed(),
    answers: questions.answers(),
    display: { ...stage.display(), focus_lost_ms: watch.lost() },
  };
}

function refused(sentence) {
  refusal = sentence;
}

function keepTime() {
  if (isAnswerable) keepShowing(words.here, trial.place, watch.kept());
}

// Another page instead of this one, once the server surely answers: on a browser's error page nothing tries again.
async function leave(go = () => location.replace(words.here)) {
  if (isLeaving) return;
  isLeaving = true;
  for (let failures = 0; ; ) {
    const reply = await askWhere(words.here, failures);
    if (!("after" in reply)) return go();
    say(words.unreachable, true);
    await pause(++failures, reply.after);
  }
}

// This page as the server makes it now; once for each release, for behind one address there may be two for a while.
function renew(release) {
  history.replaceState({ renewedFor: [...renewedFor(), release] }, "");
  leave(() => location.reload());
}

function renewedFor() {
  return history.state?.renewedFor ?? [];
}

// Nothing that is not so: "Saved" only if the server has everything.
function tell() {
  if (isLeaving) return;
  const unsaved = outbox.answers().length;
  hasAnswered ||= unsaved > 0;
  if (refusal) say(refusal, true);
  else if (delivery.isFailing && unsaved) say((trial ? words.unsaved : words.stopped).replace("{n}", unsaved), true);
  else if (delivery.isFailing) say(words.unreachable, true);
  else if (unsaved && !trial && performance.now() - answeredAt >= LONG_MS) say(words.waiting);
  else if (unsaved) say(words.saving);
  else if (hasAnswered) say(words.saved);
}

function say(sentence, isTrouble = false) {
  if (status.textContent !== sentence) status.textContent = sentence; // said anew it would be read aloud anew
  status.className = isTrouble ? "trouble" : "";
}
