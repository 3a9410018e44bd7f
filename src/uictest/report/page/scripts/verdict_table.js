/* Filters and sorting of the table of cases. */
const table = first("table.verdicts");
const filters = first("form.filters");
if (table && filters) {
  const rows = all("tbody tr", table);
  const contents = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));

  const filter = () => {
    const words = new Set(all('input[name="word"]:checked', filters).map((box) => box.value));
    const sought = filters.elements.text.value.toLowerCase().split(/\s+/);
    const { outcome, scenario } = filters.elements;
    let shown = 0;
    for (const row of rows) {
      const wanted =
        words.has(row.dataset.word) &&
        (!outcome.value || row.dataset.outcome === outcome.value) &&
        (!scenario.value || row.dataset.scenario === scenario.value) &&
        sought.every((part) => contents.get(row).includes(part));
      row.hidden = !wanted;
      shown += wanted;
    }
    first(".count", filters).textContent = `${shown} of ${rows.length} shown`;
  };
  filters.addEventListener("input", filter);
  filters.addEventListener("submit", (event) => event.preventDefault());
  filters.addEventListener("reset", () => setTimeout(filter));
  filter();

  const headings = all("thead th", table);
  const key = (row, column) => {
    const text = row.cells[column].textContent.trim();
    const number = Number.parseFloat(text);
    return headings[column].classList.contains("number") ? (Number.isNaN(number) ? Infinity : number) : text;
  };
  const sort = (column) => {
    const rising = headings[column].ariaSort !== "ascending";
    headings.forEach((heading) => heading.removeAttribute("aria-sort"));
    headings[column].ariaSort = rising ? "ascending" : "descending";
    const sorted = rows
      .map((row) => [key(row, column), row])
      .sort(([a], [b]) => (a < b ? -1 : a > b ? 1 : 0) * (rising ? 1 : -1));
    first("tbody", table).append(...sorted.map(([, row]) => row));
  };
  headings.forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    button.addEventListener("click", () => sort(column));
    heading.append(button);
  });
}
