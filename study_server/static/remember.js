// Offers the way back to somebody who opens the link a second time. Only an offer: the next person at a shared
// computer begins anew. Where storage is blocked nothing is lost but the offer.
const key = "fakesss-session";
const here = location.pathname;
const isNamed = new URLSearchParams(location.search).has("PROLIFIC_PID"); // their link always leads to their own session
const notice = document.getElementById("resume");

try {
  const earlier = localStorage.getItem(key);
  if (document.querySelector("[data-over]")) {
    if (earlier === here) localStorage.removeItem(key);
  } else if (notice && !isNamed && earlier && earlier !== here && (await begun(earlier))) {
    notice.querySelector("a").href = earlier;
    notice.hidden = false;
  }
  if (!isNamed) document.querySelector(".agree")?.addEventListener("submit", () => localStorage.setItem(key, here));
} catch {
  // storage is blocked
}

async function begun(address) {
  const response = await fetch(address, { headers: { Accept: "application/json" } });
  const over = ["consent", "done", "screened_out", "withdrawn", "paused", "closed"];
  return response.ok && !over.includes((await response.json()).step);
}
