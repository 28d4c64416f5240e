// Sweep from here: what varies, a preview of every picture, and the study that shows them to people.
import { postForFile } from "./server.js";
import { alike, combinations, drawn, SmallPictures } from "./sweep_cells.js";
import { FactorForm } from "./sweep_factor.js";
import { fill, markNow, walkable } from "./sweep_grid.js";
import { startStudy } from "./sweep_study.js";

const QUESTIONS = 3; // of the study that is written
const RATING_S = 5;
const LONG_MIN = 20; // for one sitting
const BESIDE_PX = 7; // of a picture: its border and the way to the next
const HEADER_PX = 86; // of a row

export function start(context) {
  const sweep = new Sweep(context);
  startStudy(sweep, context);
}

// Events: "change" when other pictures are asked for.
class Sweep extends EventTarget {
  cells = []; // {levels, name, settings, button}
  #preview = document.getElementById("sweep-preview");
  #table = document.getElementById("sweep-grid");
  #large = document.getElementById("sweep-large");
  #small = new SmallPictures();
  #pictures = new Map(); // cell -> its small picture, of the settings now
  #problems = new Map(); // cell -> why it has none
  #isDue = false; // some are missing, and none is being drawn
  #isBehind = false; // forms and cells: the settings went on
  #form = document.getElementById("sweep");
  #chosen = null; // the cell whose picture is on the stage
  #asked = new AbortController(); // for that picture

  constructor({ settings, stage, connection, say }) {
    super();
    Object.assign(this, { settings, stage, say });
    const [across, down] = document.querySelectorAll("#sweep .factor");
    this.forms = [new FactorForm(down, settings, true), new FactorForm(across, settings, false)];
    for (const form of this.forms) form.addEventListener("change", () => this.#vary());
    settings.addEventListener("change", ({ detail }) => this.#settingsChanged(detail));
    connection.addEventListener("message", ({ detail }) => detail.type === "again" && this.#forget());
    stage.addEventListener("still", () => this.#drawIfDue());
    stage.addEventListener("live", () => this.#choose(null));
    this.#form.addEventListener("submit", (event) => event.preventDefault());
    document.getElementById("use-these").addEventListener("click", () => this.#use());
    document.getElementById("back-to-live").addEventListener("click", () => this.#back());
    const seen = new ResizeObserver(() => this.#seen()); // the panel's tab was chosen
    for (const part of [this.#form, this.#preview]) seen.observe(part);
    this.#large.addEventListener("close", () => this.#moveTo(this.#preview.querySelector(".over")));
    this.#large.querySelector(".close").addEventListener("click", () => this.#large.close());
    document.getElementById("sweep-larger").addEventListener("click", () => this.#enlarge());
    walkable(this.#table);
  }

  // One or two, down before across: the last factor of a study varies fastest. None while one of them has a mistake.
  get factors() {
    if (this.forms.some(({ isBroken }) => isBroken)) return [];
    return this.forms.map(({ factor }) => factor).filter(Boolean);
  }

  // A sentence about pictures that are the same; "" if none are.
  get warning() {
    const same = alike(this.#pictures);
    if (!same.length) return "";
    const [[cell, earlier]] = same;
    const more = same.length > 1 ? ` and ${same.length - 1} more` : "";
    return `The same picture twice: ${cell.name} = ${earlier.name}${more}. Nobody can tell them apart.`;
  }

  // Other levels, or another setting that varies.
  #vary() {
    const { factors } = this;
    this.#preview.hidden = !factors.length;
    this.cells = factors.length ? combinations(factors, this.settings, this.settings.current) : [];
    fill(this.#table, factors, this.cells);
    for (const cell of this.cells) cell.button.addEventListener("click", () => this.#show(cell));
    this.#count();
    this.#renew();
    this.#drawIfDue();
    this.dispatchEvent(new Event("change"));
  }

  // What does not vary has changed, many times while something moves: the rest of it waits until that rests and somebody
  // looks here, and the pictures for the stage's own.
  #settingsChanged({ moving }) {
    if (this.#chosen) this.#choose(null);
    if (!this.#isBehind) this.#outdate();
    this.#isBehind = true;
    if (!moving) this.#follow();
  }

  #seen() {
    this.#follow();
    this.#drawIfDue();
  }

  #follow() {
    if (!this.#isBehind || this.settings.isMoving || !this.#form.checkVisibility()) return;
    this.#isBehind = false;
    for (const form of this.forms) form.showSettings();
    if (!this.cells.length) return;
    const next = combinations(this.factors, this.settings, this.settings.current);
    for (const [index, cell] of this.cells.entries()) cell.settings = next[index].settings;
    this.#renew();
  }

  // What is seen is not what would be drawn now.
  #outdate() {
    this.#small.stop();
    this.#pictures.clear();
    this.#problems.clear();
    this.#isDue = true;
    for (const { button } of this.cells) button.classList.add("waits");
  }

  #renew() {
    this.#outdate();
    const [width, height] = this.settings.value("size");
    for (const { button } of this.cells) button.firstElementChild.style.aspectRatio = `${width} / ${height}`;
    const columns = Number(this.#table.dataset.columns);
    this.#table.style.maxWidth = `${columns * (width / devicePixelRatio + BESIDE_PX) + HEADER_PX}px`; // no picture enlarged
    markNow(this.#table, (factor, level) => this.#isNow(factor, level));
    this.#warn();
  }

  #isNow(factor, level) {
    const { path, levels } = this.factors[factor];
    return levels[level] === drawn(this.settings, path);
  }

  async #drawIfDue() {
    const isSeen = this.#preview.checkVisibility();
    if (!isSeen) this.#small.stop();
    if (!this.#isDue || !isSeen || this.settings.isMoving || !this.cells.length) return;
    this.#isDue = false;
    const { cells } = this;
    const isDone = await this.#small.draw(
      cells,
      this.#size(),
      (cell, picture) => this.#put(cell, picture),
      (cell, problem) => this.#fail(cell, problem),
    );
    if (cells === this.cells && !isDone) this.#isDue = true;
    if (isDone) this.#warn();
  }

  // As many pixels as a cell has on the screen, no more than the scene.
  #size() {
    const [width, height] = this.settings.value("size");
    const share = Math.min(1, (this.cells[0].button.clientWidth * devicePixelRatio) / width);
    return [width, height].map((side) => Math.max(1, Math.round(side * share)));
  }

  #put(cell, picture) {
    this.#pictures.set(cell, picture);
    cell.button.firstElementChild.src = picture.address;
    cell.button.classList.remove("waits", "failed");
  }

  #fail(cell, problem) {
    this.#problems.set(cell, problem);
    cell.button.firstElementChild.removeAttribute("src");
    cell.button.classList.remove("waits");
    cell.button.classList.add("failed");
    this.#warn();
  }

  #warn() {
    const [problem] = this.#problems;
    const words = problem ? `${problem[0].name}: ${problem[1]}` : this.warning;
    const place = document.getElementById("sweep-warning");
    if (place.textContent !== words) place.textContent = words;
    place.hidden = !words;
  }

  #count() {
    const pictures = this.cells.length;
    const minutes = (pictures * QUESTIONS * RATING_S) / 60;
    const time = minutes < 1.5 ? "about a minute" : `about ${Math.round(minutes)} minutes`;
    const long = minutes > LONG_MIN ? ", long for one sitting" : "";
    const words = `${pictures} ${pictures === 1 ? "picture" : "pictures"}, ${QUESTIONS} ratings each: ${time} a person at ${RATING_S} s a rating${long}.`;
    document.getElementById("sweep-count").textContent = words;
  }

  // The shaders have changed, or something that a picture stood in for is made.
  #forget() {
    this.#small.forget();
    if (this.cells.length) this.#renew();
    if (this.#chosen) this.#bring();
  }

  #enlarge() {
    this.#large.showModal();
    this.#moveTo(this.#large.querySelector(".over"));
  }

  // The table after another element, its pictures as large as it has room for there.
  #moveTo(place) {
    place.after(this.#table.parentElement);
    this.#isDue = true;
    this.#drawIfDue();
  }

  // The whole picture on the stage; once more: the live one again.
  async #show(cell) {
    this.#large.close();
    if (cell === this.#chosen) return this.#back();
    this.#choose(cell);
    await this.#bring();
  }

  async #bring() {
    const { settings, name } = this.#chosen;
    this.#asked.abort();
    const { signal } = (this.#asked = new AbortController());
    try {
      const blob = await postForFile("picture", { settings }, signal);
      if (!signal.aborted) await this.stage.show(blob, name);
    } catch (problem) {
      if (signal.aborted) return;
      this.#back();
      this.say("error", problem.message);
    }
  }

  #choose(cell) {
    this.#asked.abort();
    this.#chosen?.button.setAttribute("aria-pressed", "false");
    this.#chosen = cell;
    cell?.button.setAttribute("aria-pressed", "true");
    const place = document.getElementById("sweep-cell");
    if (!cell && place.contains(document.activeElement)) this.#table.querySelector("[tabindex='0']")?.focus();
    place.hidden = !cell;
    place.querySelector("output").textContent = cell?.name ?? "";
  }

  #use() {
    const { settings } = this.#chosen;
    this.#back();
    this.settings.replace(settings);
  }

  #back() {
    this.#choose(null);
    this.stage.showLive();
  }
}
