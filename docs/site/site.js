// Formulas, and tables that are sorted by a click, Enter or Space on the head of a column.
"use strict";

function set_formulas() {
  for (const element of document.querySelectorAll(".formula")) {
    katex.render(element.textContent, element, { displayMode: element.classList.contains("display"), throwOnError: false });
  }
}

// The number that a cell begins with, or that follows a sign or a quotation mark; else null.
function number_of(text) {
  const match = text.replace(/,/g, "").match(/^[^\d-]{0,2}(-?\d+(\.\d+)?(e[+-]?\d+)?)/i);
  return match ? Number(match[1]) : null;
}

function before(a, b) {
  const x = number_of(a), y = number_of(b);
  if (x !== null && y !== null && x !== y) return x - y;
  if ((x === null) !== (y === null)) return x === null ? 1 : -1;
  return a.localeCompare(b);
}

function sort_by(table, column, head) {
  const ascending = head.getAttribute("aria-sort") !== "ascending";
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const text = (row) => row.cells[column].textContent.trim();
  const rows = [...table.tBodies[0].rows].sort((a, b) => (ascending ? 1 : -1) * before(text(a), text(b)));
  table.tBodies[0].append(...rows);
}

function make_sortable(table) {
  for (const cell of table.querySelectorAll("td")) {
    const text = cell.textContent.trim();
    if (text.length < 24 && number_of(text) !== null) cell.classList.add("number");
  }
  if (!table.tHead || table.tBodies[0].rows.length < 3) return;
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    if (head.textContent.trim() === "") return;
    head.classList.add("sortable");
    head.tabIndex = 0;
    head.addEventListener("click", () => sort_by(table, column, head));
    head.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      sort_by(table, column, head);
    });
  });
}

document.addEventListener("DOMContentLoaded", () => {
  set_formulas();
  document.querySelectorAll("table.docutils").forEach(make_sortable);
});
