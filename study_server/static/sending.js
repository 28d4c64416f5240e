// Talking to the server over a network that may be gone for minutes: every request is repeated until it is answered.
const LONGEST_WAIT_MS = 10_000;

// The participant's current page as the server's dict.
export function state(here, say) {
  return untilAnswered(() => fetch(here, { headers: { Accept: "application/json" }, cache: "no-store" }), say);
}

// Send a trial's answers; `body()` is called for each attempt. Resolves to the server's dict, saved or refused.
export function post(here, body, say) {
  const send = () =>
    fetch(`${here}/ratings`, {
      method: "POST",
      headers: { "Content-Type": "application/json", Accept: "application/json" },
      body: JSON.stringify(body()),
      signal: AbortSignal.timeout(30_000),
    });
  return untilAnswered(send, say);
}

// A refusal (4xx) is an answer; no connection, a time-out or a server in trouble (5xx) is not.
async function untilAnswered(request, say) {
  for (let attempt = 1; ; attempt++) {
    try {
      const response = await request();
      if (response.status < 500) return await response.json();
    } catch {
      // no connection, a broken one, or half an answer
    }
    say("Not saved yet – trying again. Please keep this page open.", true);
    await backOnlineOr(Math.min(250 * 2 ** attempt, LONGEST_WAIT_MS) * (0.75 + Math.random() / 2));
  }
}

function backOnlineOr(ms) {
  return new Promise((resolve) => {
    setTimeout(resolve, ms);
    window.addEventListener("online", resolve, { once: true });
  });
}
