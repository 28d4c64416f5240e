// The preview's table: a button for each picture, moved between by arrow keys.

const A_ROW = 3; // pictures, where only one setting varies

// `factors` are one or two, the last across. Gives each cell its `button`.
export function fill(table, factors, cells) {
  const isTwo = factors.length > 1;
  const columns = isTwo ? factors[1].levels.length : Math.min(A_ROW, cells.length);
  const rows = isTwo ? heads(factors) : [];
  for (let first = 0; first < cells.length; first += columns) {
    const row = document.createElement("tr");
    if (isTwo) row.append(header(factors, 0, first / columns, "row"));
    const members = cells.slice(first, first + columns);
    row.append(...members.map((cell, index) => place(cell, isTwo ? null : label("span", factors, 0, first + index))));
    rows.push(row);
  }
  table.replaceChildren(...rows);
  table.dataset.columns = columns;
  if (cells.length) cells[0].button.tabIndex = 0;
}

// The levels that are the settings' values: `isNow(factor, level)`, both counted from 0.
export function markNow(table, isNow) {
  for (const { dataset, lastElementChild } of table.querySelectorAll("[data-level]")) {
    lastElementChild.hidden = !isNow(Number(dataset.factor), Number(dataset.level));
  }
}

function heads(factors) {
  const [down, across] = factors;
  const names = document.createElement("tr");
  const corner = Object.assign(document.createElement("th"), { textContent: down.name, rowSpan: 2, scope: "col" });
  names.append(corner, Object.assign(document.createElement("th"), { textContent: across.name, colSpan: across.levels.length }));
  const levels = document.createElement("tr");
  levels.append(...across.levels.map((_, index) => header(factors, 1, index, "col")));
  return [names, levels];
}

function header(factors, factor, level, scope) {
  return Object.assign(label("th", factors, factor, level), { scope });
}

function label(kind, factors, factor, level) {
  const made = document.createElement(kind);
  Object.assign(made.dataset, { factor, level });
  const now = Object.assign(document.createElement("span"), { className: "is-now", textContent: " now", hidden: true });
  made.append(factors[factor].labels[level], now);
  return made;
}

function place(cell, words) {
  const made = document.createElement("td");
  cell.button = Object.assign(document.createElement("button"), { type: "button", tabIndex: -1 });
  cell.button.setAttribute("aria-label", cell.name);
  cell.button.setAttribute("aria-pressed", "false");
  cell.button.append(Object.assign(document.createElement("img"), { alt: "" }), ...(words ? [words] : []));
  made.append(cell.button);
  return made;
}

// Arrow keys, Home and End lead from picture to picture; only one of them is on Tab's way.
export function walkable(table) {
  table.addEventListener("keydown", (event) => {
    const buttons = [...table.querySelectorAll("button")];
    const at = buttons.indexOf(event.target);
    const columns = Number(table.dataset.columns);
    const by = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -columns, ArrowDown: columns, Home: -at, End: buttons.length - 1 - at };
    const to = buttons[at + by[event.key]];
    if (at < 0 || !to || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation(); // the page's own keys have other meanings for them
    to.focus();
  });
  table.addEventListener("focusin", ({ target }) => {
    for (const button of table.querySelectorAll("button")) button.tabIndex = button === target ? 0 : -1;
  });
}
