/* Heat maps: choose parameters and measure; read a cell with the pointer or the arrow keys. */
const SVG = "http://www.w3.org/2000/svg";
const drawnElement = (tag, attributes) => {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
};

/* The table of a map as rows of texts: what its cells say, and the CSV of it. */
const headsOf = (figure) => all("thead th", figure).map((each) => each.textContent);
const bodyOf = (figure) => all("tbody tr", figure);
const valueOf = (cell) => {
  const value = cell.firstChild; /* without a case there is none, and the words on its cases come first */
  return value.nodeName === "SMALL" ? "" : value.textContent;
};

const csvOfHeat = (figure) => {
  const heads = headsOf(figure);
  const { down, across } = figure.closest(".heat-pair").dataset;
  const lines = bodyOf(figure).flatMap((row) =>
    all("td", row).map((cell, k) => [first("th", row).textContent, heads[k], valueOf(cell), first("small", cell).textContent]));
  return csvLines([[down, across, first("h3", figure).textContent, "cases"], ...lines]);
};

/* Which of the stretches between edges a place lies in; -1 beside all of them. */
const stretchAt = (edges, place) =>
  edges.slice(1).findIndex((edge, k) => (place - edges[k]) * (place - edge) <= 0);

const offerHeat = (figure) => {
  const view = first(".heat-view", figure);
  const svg = first("svg", view);
  const [x, y] = [svg.dataset.x, svg.dataset.y].map((text) => text.split(" ").map(Number));
  const rings = ["heat-ring", "heat-ring inner"].map((name) => svg.appendChild(drawnElement("rect", { class: name, visibility: "hidden" })));
  const output = first("output", figure);
  const heads = headsOf(figure);
  const { down, across } = figure.closest(".heat-pair").dataset;
  const cellAt = (row, column) => first("table", figure).tBodies[0].rows[row].cells[column + 1];
  const put = (row, column) => {
    const box = { x: Math.min(x[column], x[column + 1]), y: Math.min(y[row], y[row + 1]),
      width: Math.abs(x[column + 1] - x[column]), height: Math.abs(y[row + 1] - y[row]), visibility: "visible" };
    for (const ring of rings) for (const [name, value] of Object.entries(box)) ring.setAttribute(name, value);
    const cell = cellAt(row, column);
    const label = bodyOf(figure)[row].cells[0].textContent;
    const where = `${down} = ${label}, ${across} = ${heads[column]}`;
    const unit = first("h3", figure).textContent;
    output.textContent = `${where}: ${valueOf(cell) || "no value"} (${unit}); ${first("small", cell).textContent}`;
    const link = first("a", cell);
    if (link) output.append("; ", make("a", "its worst stop", { href: link.getAttribute("href") }));
  };
  /* The maps of one pair of parameters have the same cells, and one cursor. */
  const share = (row, column) => {
    view.dataset.at = `${row} ${column}`;
    for (const each of all(".heat:not([hidden])", figure.parentElement)) each.putCursor?.(row, column);
  };
  figure.putCursor = put;
  const placeOf = (event) => {
    const box = svg.getBoundingClientRect();
    const scale = svg.viewBox.baseVal.width / box.width;
    return [stretchAt(y, (event.clientY - box.top) * scale), stretchAt(x, (event.clientX - box.left) * scale)];
  };
  const follow = (event) => {
    const [row, column] = placeOf(event);
    if (row >= 0 && column >= 0) share(row, column);
    return row >= 0 && column >= 0 ? first("a", cellAt(row, column)) : null;
  };
  view.addEventListener("pointermove", follow);
  view.addEventListener("click", (event) => follow(event)?.click());
  view.tabIndex = 0;
  view.setAttribute("role", "group");
  view.setAttribute("aria-label", `${svg.getAttribute("aria-label")}; arrow keys move from cell to cell`);
  const [up, right] = [y[1] < y[0] ? 1 : -1, x[1] > x[0] ? 1 : -1];
  const STEPS = { ArrowUp: [up, 0], ArrowDown: [-up, 0], ArrowRight: [0, right], ArrowLeft: [0, -right] };
  view.addEventListener("keydown", (event) => {
    const [row, column] = (view.dataset.at ?? "").split(" ").map(Number);
    if (event.key === "Enter" && view.dataset.at) return first("a", cellAt(row, column))?.click();
    const step = STEPS[event.key];
    if (!step) return undefined;
    event.preventDefault();
    const within = (place, edges) => Math.min(Math.max(place, 0), edges.length - 2);
    return view.dataset.at ? share(within(row + step[0], y), within(column + step[1], x)) : share(0, 0);
  });
  first("button.csv", figure).addEventListener("click", () => save(`${figure.id}.csv`, csvOfHeat(figure)));
};

const offerHeats = (section) => {
  const pairChoice = first('[data-choice="pair"]', section);
  const measureChoice = first('[data-choice="measure"]', section);
  const pairs = all(".heat-pair", section);
  const offered = new Set();
  const show = () => {
    for (const pair of pairs) {
      pair.hidden = pair.dataset.pair !== (pairChoice?.value ?? "1");
      for (const figure of all(".heat", pair)) {
        const always = figure === first(".heat", pair) && !("uniform" in figure.dataset);
        figure.hidden = !always && figure.dataset.measure !== measureChoice.value;
        if (pair.hidden || figure.hidden || offered.has(figure)) continue;
        offered.add(figure);
        offerHeat(figure);
      }
    }
  };
  /* A link to a map that is not shown chooses it. */
  const chooseTarget = () => {
    const figure = target(location.hash)?.closest(".heat");
    if (!figure) return;
    if (pairChoice) pairChoice.value = figure.closest(".heat-pair").dataset.pair;
    if (figure.previousElementSibling) measureChoice.value = figure.dataset.measure;
    show();
  };
  for (const choice of [pairChoice, measureChoice]) choice?.addEventListener("change", show);
  addEventListener("hashchange", chooseTarget);
  show();
  chooseTarget();
};
all(".heat-maps").forEach(offerHeats);

/* Tables that the page holds as text. */
if (first("#plot-tables")) {
  const tables = json(first("#plot-tables"));
  for (const button of all("button[data-table]"))
    button.addEventListener("click", () => save(button.dataset.table, tables[button.dataset.table]));
}
