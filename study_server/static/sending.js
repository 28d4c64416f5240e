// Talking to the server over a network that may be gone for minutes. An answer is what our server says, granted or refused;
// everything else (no connection, a time-out, half a reply, a proxy's page, a server in trouble) is tried again.
const FIRST_PATIENCE_MS = 5_000; // a connection that a router forgot never answers; a browser may keep six of them
const MORE_PATIENCE_MS = 2_000; // after every failure: the server may be slow, or the line
const LONGEST_PATIENCE_MS = 30_000;
const LONGEST_WAIT_MS = 10_000;
const LONGEST_RETRY_AFTER_MS = 300_000;

// `failures`: how many attempts got no answer before this one.
// {page}: where the session stands, as the server's dict; {refused: sentence}; or {after: ms} to wait at least.
export function askWhere(here, failures) {
  return request(here, {}, failures, (reply) => reply.step && { page: reply });
}

// {page} that comes next, now that the answers of one trial are on the server's disk; {refused}; or {after}.
export function send(here, answer, failures) {
  const headers = { "Content-Type": "application/json" };
  // keepalive: also while the tab is closed. Chromium then keeps the connection of an attempt that was given up, too, and
  // of six such there is none left for the next: so only the first attempt.
  const how = { method: "POST", headers, body: JSON.stringify(answer), keepalive: failures === 0 };
  return request(`${here}/ratings`, how, failures, (reply) => reply.saved && reply.next && { page: reply.next });
}

async function request(address, how, failures, granted) {
  try {
    const headers = { ...how.headers, Accept: "application/json" };
    const patience = Math.min(FIRST_PATIENCE_MS + MORE_PATIENCE_MS * failures, LONGEST_PATIENCE_MS);
    const signal = AbortSignal.timeout(patience);
    const response = await fetch(address, { ...how, headers, signal, cache: "no-store" });
    const { status } = response;
    if (status >= 500 || status === 408 || status === 429) return { after: retryAfter(response) };
    const reply = await response.json();
    if (response.ok) return granted(reply) || { after: 0 };
    return typeof reply.error === "string" ? { refused: reply.error } : { after: 0 };
  } catch {
    return { after: 0 };
  }
}

// Retry-After is a number of seconds or a date (RFC 9110, 10.2.3).
function retryAfter(response) {
  const told = response.headers.get("Retry-After") ?? "";
  const ms = /^\d+$/.test(told) ? told * 1000 : Date.parse(told) - Date.now();
  return Math.min(Math.max(ms || 0, 0), LONGEST_RETRY_AFTER_MS);
}

// Longer after every failure, and not the same for all, lest a whole class comes back at one moment; at once when the
// network is back, but never before the server wants it.
export async function pause(failures, after) {
  const wait = Math.min(250 * 2 ** failures, LONGEST_WAIT_MS) * (0.75 + Math.random() / 2);
  const asked = new Promise((resolve) => setTimeout(resolve, after));
  const over = new AbortController();
  await new Promise((resolve) => {
    setTimeout(resolve, wait);
    window.addEventListener("online", resolve, { signal: over.signal });
  });
  over.abort();
  await asked;
}
