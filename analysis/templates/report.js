// Makes tables sortable by their heads. The order of every column was decided when the report was written (data-place);
// without this script the page is complete, in the order of the design.
"use strict";

for (const table of document.querySelectorAll("figure.table table")) {
  const body = table.tBodies[0];
  const asWritten = [...body.rows];
  if (asWritten.length < 2) continue;
  const heads = [...table.tHead.rows[0].cells];

  const place = (row, column) => Number(row.cells[column].dataset.place ?? Infinity); // no value: last either way
  const sort = (column, direction) => {
    const rows = direction === 0 ? asWritten : [...asWritten].sort((a, b) => {
      const [first, second] = [place(a, column), place(b, column)];
      if (first === second) return 0;
      return first === Infinity || second === Infinity ? first - second : direction * (first - second);
    });
    body.append(...rows);
    table.classList.toggle("sorted", direction !== 0);
    heads.forEach((head, i) => {
      if (i === column && direction !== 0) head.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
    });
  };

  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.title = "Sort by this column; a third time: the order of the design";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const now = { ascending: 1, descending: -1 }[head.getAttribute("aria-sort")] ?? 0;
      sort(column, { 0: 1, 1: -1, "-1": 0 }[now]);
    });
  });
}
