// The admin page kept up to date: the page's own address as JSON every few seconds, put where the server had put it.
// It asks while somebody can see it; slower where answers take long; and it says when the server or the door is shut.
const EVERY_MS = 5_000;
const LONGEST_WAIT_MS = 60_000;
const SPOKEN_EVERY_MS = 60_000;

const trouble = document.getElementById("trouble");
const updated = document.getElementById("updated");
const spoken = document.getElementById("spoken");

let timer = 0;
let asking = false;
let ended = false;  // the door is closed: only a person opens it again
let wait = EVERY_MS;
let lastSpoken = performance.now();

document.addEventListener("visibilitychange", () => askIn(0));
window.addEventListener("online", () => askIn(0));
updated.textContent = `Updates by itself; these are the figures of ${clock()}.`;
askIn(EVERY_MS);

function askIn(ms) {
  clearTimeout(timer);
  if (!ended && !asking && !document.hidden) timer = setTimeout(ask, ms);
}

async function ask() {
  asking = true;
  const begun = performance.now();
  try {
    const response = await fetch("/admin", { headers: { Accept: "application/json" }, cache: "no-store", signal: AbortSignal.timeout(30_000) });
    if (response.status === 401) closeDoor();
    else if (!response.ok) throw new Error(`status ${response.status}`);
    else {
      show(await response.json());
      wait = Math.max(EVERY_MS, 20 * (performance.now() - begun));  // at most a twentieth of the server's time
    }
  } catch {
    say(trouble, "The server does not answer. Trying again …");
    wait = Math.min(2 * wait, LONGEST_WAIT_MS);
  }
  asking = false;
  askIn(wait);
}

function closeDoor() {
  ended = true;
  const link = Object.assign(document.createElement("a"), { href: "/admin", textContent: "open it with the secret" });
  trouble.replaceChildren("The door has closed, and nothing is updated any more; ", link, ".");
}

function show(data) {
  data.busiest = Math.max(...data.ratings_by_minute);
  for (const place of document.querySelectorAll("[data-figure]")) say(place, told(place.dataset.figure, valueAt(data, place.dataset.figure)));
  for (const table of document.querySelectorAll("[data-rows]")) fill(table, valueAt(data, table.dataset.rows));
  for (const form of document.querySelectorAll("[data-leads-to]")) form.hidden = form.dataset.leadsTo === data.gate.state;
  document.querySelector("[data-gate]").dataset.gate = data.gate.state;
  document.querySelector(".hour path").setAttribute("d", bars(data.ratings_by_minute));
  say(trouble, "");
  updated.textContent = `Updates by itself; these are the figures of ${clock()}.`;
  speak(data);
}

// Rows made or taken away as needed; what is there stays, and so does where the reader is.
function fill(table, rows) {
  const body = table.tBodies[0];
  while (body.rows.length > rows.length) body.lastElementChild.remove();
  while (body.rows.length < rows.length) body.append(table.querySelector("template").content.firstElementChild.cloneNode(true));
  const most = Math.max(1, ...rows.map((row) => row[table.querySelector("template").content.querySelector("[data-bar]")?.dataset.bar] ?? row.q3_s ?? 0));
  rows.forEach((row, i) => fillRow(body.rows[i], row, most));
  table.hidden = rows.length === 0;
  table.nextElementSibling.hidden = rows.length > 0;
}

function fillRow(line, row, most) {
  for (const cell of line.querySelectorAll("[data-key]")) say(cell, told(cell.dataset.key, row[cell.dataset.key]));
  for (const bar of line.querySelectorAll("[data-bar]")) Object.assign(bar, { max: most, value: row[bar.dataset.bar] });
  for (const box of line.querySelectorAll(".box")) {
    box.setAttribute("viewBox", `0 0 ${most} 10`);
    set(box.querySelector("rect"), { x: row.q1_s, width: row.q3_s - row.q1_s });
    set(box.querySelector("line"), { x1: row.median_s, x2: row.median_s });
  }
}

function bars(counts) {
  const most = Math.max(1, ...counts);
  return counts.map((n, i) => `M${i}.1 10v${Math.round((-1000 * n) / most) / 100}h.8V10z`).join("");
}

// For who listens: once a minute, and only if something has changed.
function speak(data) {
  if (performance.now() - lastSpoken < SPOKEN_EVERY_MS) return;
  lastSpoken = performance.now();
  say(spoken, `${data.started} started, ${data.finished} finished, ${data.active} active, ${data.dropped} dropped; ${data.ratings} ratings.`);
}

// Times have one decimal, as the server writes them.
function told(key, value) {
  return /_s$|_minutes$/.test(key) ? (value?.toFixed(1) ?? "–") : value;
}

function say(place, words) {
  if (place.textContent !== String(words)) place.textContent = words;
}

function set(shape, values) {
  for (const [name, value] of Object.entries(values)) shape.setAttribute(name, value);
}

function valueAt(data, path) {
  return path.split(".").reduce((value, key) => value[key], data);
}

function clock() {
  return new Date().toLocaleTimeString();
}
