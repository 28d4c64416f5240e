// On the pages after the trials: brings to the server what a trial's page could not any more, because the study was closed
// or another tab had gone on. Nothing is left behind on the computer of somebody who is through or has withdrawn.
import { Outbox } from "/static/outbox.js";
import { pause, send } from "/static/sending.js";
import { forgetShowing } from "/static/showing.js";

const here = location.pathname;
const step = document.body.className;
const outbox = new Outbox(here, () => {});

if (step === "done" || step === "withdrawn") forgetShowing(here);

for (const answer of outbox.answers()) {
  const isKnown = step === "withdrawn" || (await isAnswered(answer));
  if (isKnown || step === "done") outbox.remove(answer);
}

// Whether the server has it; a refusal is the other answer there is.
async function isAnswered(answer) {
  for (let failures = 0; ; failures++) {
    const reply = await send(here, answer, failures);
    if (!("after" in reply)) return "page" in reply;
    await pause(failures + 1, reply.after);
  }
}
