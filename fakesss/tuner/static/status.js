// How fast pictures come and what they cost; what is wrong with the one that is shown.

const RATE_S = 5; // of moving pictures, over which the frame rates are told
const PAUSE_MS = 50; // from a frame to the next input: the hand rested
const LATENCIES = 60; // of which the median is told
const REDRAW_MS = 250; // numbers that change faster cannot be read

export function start({ connection, stage, say }) {
  const rates = new Rates();
  const latencies = [];
  let header = null;
  let isDue = false;

  function redraw() {
    isDue = false;
    text("rate", rates.inWords());
    text("latency", latencies.length ? `${Math.round(median(latencies))} ms` : "–");
    text("draw-ms", spent(header.times));
    text("mesh", `${header.faces.toLocaleString("en")} faces · ${header.vertices.toLocaleString("en")} vertices`);
    if (!header.moving && !document.getElementById("passes").hidden) passes(header.passes);
  }

  stage.addEventListener("frame", ({ detail }) => {
    ({ header } = detail);
    if (header.moving) {
      rates.add(performance.now(), detail.asked);
      latencies.push(detail.latency);
      if (latencies.length > LATENCIES) latencies.shift();
    }
    if (isDue) return;
    isDue = true;
    setTimeout(redraw, header.moving ? REDRAW_MS : 0);
  });
  drawer("show-passes", "passes", () => stage.picture() && passes(stage.picture().header.passes));
  drawer("show-messages", "messages", () => (document.getElementById("log").scrollTop = 1e9));
  warnings(stage, say);
  notices(connection, stage);
}

// Of moving frames, as the thesis tells them: least, mean and most a second. A hand that rests is no slow frame.
class Rates {
  #last = -Infinity;
  #between = []; // {at, ms}

  add(now, asked) {
    if (asked - this.#last < PAUSE_MS) this.#between.push({ at: now, ms: now - this.#last });
    this.#last = now;
    this.#between = this.#between.filter(({ at }) => now - at < RATE_S * 1000);
  }

  inWords() {
    const all = this.#between.map(({ ms }) => ms);
    if (!all.length) return "–";
    const mean = all.reduce((sum, ms) => sum + ms) / all.length;
    return [Math.max(...all), mean, Math.min(...all)].map(perSecond).join(" · ");
  }
}

function perSecond(ms) {
  const rate = 1000 / ms;
  return rate.toFixed(rate < 10 ? 1 : 0);
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return (sorted[Math.floor((sorted.length - 1) / 2)] + sorted[Math.ceil((sorted.length - 1) / 2)]) / 2;
}

function spent({ wait, draw, encode }) {
  const others = wait >= 1 ? ` · wait ${Math.round(wait)}` : "";
  return `${draw.toFixed(draw < 10 ? 1 : 0)} ms · encode ${encode.toFixed(encode < 10 ? 1 : 0)}${others}`;
}

function text(id, words) {
  document.getElementById(id).textContent = words;
}

// What ran for the last still picture (moving ones are not timed), each with a bar, then what was left out and why.
function passes(told) {
  const total = told.reduce((sum, { gpu_ms: ms }) => sum + (ms ?? 0), 0);
  const ordered = [...told.filter(({ kept }) => kept), ...told.filter(({ kept }) => !kept)];
  document.querySelector("#passes tbody").replaceChildren(...ordered.map((one) => row(one, total)));
}

function row({ name, kept, because, gpu_ms: ms }, total) {
  const line = document.createElement("tr");
  line.className = kept ? "" : "culled";
  const heading = Object.assign(document.createElement("th"), { scope: "row", textContent: name.replaceAll("_", " ") });
  const bar = document.createElement("td");
  if (ms !== null && total > 0) {
    const meter = document.createElement("span");
    meter.className = "share";
    meter.style.width = `${(100 * ms) / total}%`;
    bar.append(meter);
  }
  const cost = ms === null ? (kept ? "–" : "") : ms.toFixed(2);
  const [time, why] = [cost, kept ? because : `left out: ${because}`].map((words) =>
    Object.assign(document.createElement("td"), { textContent: words }),
  );
  line.append(heading, time, bar, why);
  return line;
}

function drawer(button, id, opened) {
  const place = document.getElementById(id);
  document.getElementById(button).addEventListener("click", ({ currentTarget }) => {
    place.hidden = !place.hidden;
    currentTarget.setAttribute("aria-expanded", !place.hidden);
    if (!place.hidden) opened();
  });
}

// What the picture is warned of is said when it begins to be true, not with every picture and its other numbers.
function warnings(stage, say) {
  let told = new Set();
  stage.addEventListener("still", () => {
    const now = stage.picture().header.warnings;
    for (const sentence of now) if (!told.has(withoutNumbers(sentence))) say("warning", sentence);
    told = new Set(now.map(withoutNumbers));
  });
}

function withoutNumbers(sentence) {
  return sentence.replace(/[\d.]+/g, "");
}

// Over the picture, for as long as it is not the one that was asked for: the last good one stays.
function notices(connection, stage) {
  const notice = document.getElementById("notice");
  const working = document.getElementById("working");
  const show = (words) => {
    notice.textContent = words;
    notice.hidden = !words;
  };
  connection.addEventListener("lost", ({ detail }) => {
    const server = detail.tries > 2 ? " Is `fakesss tune` still running?" : "";
    show(`The connection is lost; this is the last picture. Trying again …${server}`);
  });
  connection.addEventListener("open", () => show(""));
  connection.addEventListener("message", ({ detail }) => {
    if (detail.type === "again") stage.redraw();
    if (detail.type === "working") working.textContent = detail.done ? "" : `Preparing: ${detail.what} …`;
    if (detail.type === "message" && detail.level === "error") show(`This is the last good picture. ${detail.text}`);
  });
  stage.addEventListener("frame", () => show(""));
}
