/* Filters and sorting of the table of cases. What rows say is only read once it is asked for. */
const table = first("table.verdicts");
const filters = first("form.filters");
if (table && filters) {
  const rows = all("tbody tr", table);
  const count = first("p.count");
  const once = (read) => {
    let known;
    return () => (known ??= rows.map(read));
  };

  /* Rows fill the blocks anew, those that are shown first: few blocks are in sight, and only they cost time. */
  const blocks = all("tbody", table).map((body) => ({ body, rows: [...body.rows] }));
  const most = blocks[0]?.rows.length;
  let order = rows;
  const arrange = () => {
    const placed = [...order.filter((row) => !row.hidden), ...order.filter((row) => row.hidden)];
    blocks.forEach((block, place) => {
      const own = placed.slice(place * most, (place + 1) * most);
      if (own.some((row, k) => row !== block.rows[k])) block.body.replaceChildren(...own);
      block.rows = own;
      const shown = own.filter((row) => !row.hidden).length;
      block.body.hidden = !shown;
      block.body.style.setProperty("--shown", shown);
    });
  };

  const contents = once((row) => row.textContent.toLowerCase());
  const filter = () => {
    const words = new Set(all('input[name="word"]:checked', filters).map((box) => box.value));
    const sought = filters.elements.text.value.toLowerCase().split(/\s+/).filter(Boolean);
    const texts = sought.length ? contents() : [];
    const [outcome, scenario] = [filters.elements.outcome.value, filters.elements.scenario.value];
    let shown = 0;
    rows.forEach((row, k) => {
      const wanted =
        words.has(row.dataset.word) &&
        (!outcome || row.dataset.outcome === outcome) &&
        (!scenario || row.dataset.scenario === scenario) &&
        sought.every((part) => texts[k].includes(part));
      row.hidden = !wanted;
      shown += wanted;
    });
    arrange();
    count.textContent = `${shown} of ${rows.length} shown`;
    count.classList.toggle("all", shown === rows.length);
  };
  filters.addEventListener("input", filter);
  filters.addEventListener("submit", (event) => event.preventDefault());
  filters.addEventListener("reset", () => setTimeout(filter));
  filter();

  const headings = all("thead th", table);
  const keys = headings.map((heading, column) => once((row) => {
    const text = row.cells[column].textContent.trim();
    const number = text === "turns" ? 0 : Number.parseFloat(text);
    return heading.classList.contains("number") ? number : text;
  }));
  const sort = (column) => {
    const rising = headings[column].ariaSort !== "ascending";
    headings.forEach((heading) => heading.removeAttribute("aria-sort"));
    headings[column].ariaSort = rising ? "ascending" : "descending";
    const own = keys[column]();
    const places = rows.map((_, k) => k);
    const missing = (place) => Number(Number.isNaN(own[place])); // stands last either way
    const compared = (a, b) => (own[a] < own[b] ? -1 : own[a] > own[b] ? 1 : 0) * (rising ? 1 : -1);
    places.sort((a, b) => missing(a) - missing(b) || compared(a, b));
    order = places.map((k) => rows[k]);
    arrange();
  };
  headings.forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    button.addEventListener("click", () => sort(column));
    heading.append(button);
  });
}
