/* The index of a folder: filter the cases; a mark names its run, and a click on it opens the case there. */
const histories = first("table.history");
if (histories) {
  const rows = all("tbody tr", histories);
  const contents = new Map(rows.map((row) => [row, row.cells[1].textContent.toLowerCase()]));
  const form = first("form.history-filter");
  const filter = () => {
    const sought = form.elements.text.value.toLowerCase().split(/\s+/);
    let shown = 0;
    for (const row of rows) {
      row.hidden = !sought.every((part) => contents.get(row).includes(part));
      shown += !row.hidden;
    }
    first(".count", form).textContent = `${shown} of ${rows.length} shown`;
  };
  form.addEventListener("input", filter);
  form.addEventListener("submit", (event) => event.preventDefault());
  filter();

  const slots = json(first("#slots"));
  const label = first(".strip-label");
  const slotAt = (event) => {
    const strip = event.target.closest("svg.strip");
    if (!strip) return null;
    const { left, width } = strip.getBoundingClientRect();
    const place = Math.floor(((event.clientX - left) / width) * slots.length);
    return slots[Math.min(Math.max(place, 0), slots.length - 1)];
  };
  histories.addEventListener("pointermove", (event) => {
    const slot = slotAt(event);
    label.hidden = !slot;
    if (!slot) return;
    label.textContent = slot.label;
    label.style.left = `${Math.min(event.clientX + 14, innerWidth - label.offsetWidth - 8)}px`;
    label.style.top = `${event.clientY + 16}px`;
  });
  histories.addEventListener("pointerleave", () => (label.hidden = true));
  histories.addEventListener("click", (event) => {
    const slot = slotAt(event);
    if (slot?.href) location.href = `${slot.href}#${encodeURIComponent(event.target.closest("tr").id)}`;
  });
}
