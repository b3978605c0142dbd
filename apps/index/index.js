"use strict";
// Sorts and filters the table, and shows the numbers of two chosen results side by side.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const body = document.querySelector("#results tbody");
  const heads = [...document.querySelectorAll("#results th[aria-sort]")];
  const place = document.getElementById("comparison");

  const make = (name, text, parent) => {
    const element = document.createElement(name);
    if (text !== undefined) element.textContent = text;
    if (parent) parent.append(element);
    return element;
  };

  heads.forEach((head, column) => head.querySelector("button").addEventListener("click", () => {
    const rising = head.getAttribute("aria-sort") !== "ascending";
    heads.forEach(other => other.setAttribute("aria-sort", "none"));
    head.setAttribute("aria-sort", rising ? "ascending" : "descending");
    const key = row => row.cells[column + 1].textContent;
    const rows = [...body.rows].sort((a, b) =>
      key(a).localeCompare(key(b), undefined, { numeric: true }) * (rising ? 1 : -1));
    body.append(...rows);
  }));

  document.querySelector(".filter input").addEventListener("input", event => {
    const word = event.target.value.toLowerCase();
    [...body.rows].forEach(row => { row.hidden = !row.textContent.toLowerCase().includes(word); });
  });

  const shown = (value, digits = 6) => value === undefined || value === null ? "–"
    : typeof value === "number" ? String(Number(value.toPrecision(digits))).replace("-", "−") : String(value);

  // In per cent of the first number.
  const difference = (a, b) => {
    if (typeof a !== "number" || typeof b !== "number") return a === b ? "" : "differs";
    if (a === b) return "";
    return a === 0 ? shown(b - a, 3) : `${b > a ? "+" : ""}${shown(100 * (b - a) / Math.abs(a), 3)} %`;
  };

  const compare = (one, other) => {
    place.replaceChildren();
    make("h2", "Side by side", place);
    const table = make("table", undefined, make("div", undefined, place));
    table.parentElement.className = "table";
    const head = make("tr", undefined, make("thead", undefined, table));
    ["name (unit at its end)", one.folder, other.folder, "difference"].forEach(text => make("th", text, head));
    const rows = make("tbody", undefined, table);
    const a = new Map(one.numbers), b = new Map(other.numbers);
    a.set("answer", one.sentence || null);
    b.set("answer", other.sentence || null);
    [...new Set(["answer", ...a.keys(), ...b.keys()])].forEach(name => {
      const row = make("tr", undefined, rows), text = difference(a.get(name), b.get(name));
      if (text === "") row.className = "same";
      [name, shown(a.get(name)), shown(b.get(name)), name === "answer" ? "" : text]
        .forEach(cell => make("td", cell, row));
    });
  };

  let chosen = [];  // the last two boxes, the older first
  body.addEventListener("change", event => {
    const box = event.target;
    chosen = chosen.filter(other => other !== box);
    if (box.checked) chosen.push(box);
    if (chosen.length > 2) chosen.shift().checked = false;
    [...body.rows].forEach(row => row.classList.toggle("chosen", row.querySelector("input").checked));
    if (chosen.length === 2) compare(...chosen.map(other => data[Number(other.value)]));
    else place.replaceChildren();
  });
})();
