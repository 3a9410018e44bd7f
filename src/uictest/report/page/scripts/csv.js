/* The points behind plots as a file. */
const numberText = (value, digits) => (Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : "");
const cellText = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const csvLines = (rows) => rows.map((row) => `${row.map(cellText).join(",")}\n`).join("");

const csvOf = (stop, head, rows) => `# case: ${stop.id}\n# sampling: ${stop.sampling}\n${csvLines([head, ...rows])}`;

const save = (name, text) => {
  const link = make("a", "", { download: name, href: URL.createObjectURL(new Blob([text], { type: "text/csv" })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
};

/* Every sample that the plots hold of a stop: a row for each time, a column for each channel with its unit. */
const tableOf = (stop) => {
  const names = Object.keys(stop.curves).filter((name) => !name.startsWith("valve_command"));
  const valves = ROWS.map((n) => `valve_command_${n}`).filter((name) => name in stop.curves);
  const unitOf = (name) => common.quantities[name.replace(/_[1-4]$/, "")].unit;
  const grid = stop.curves[names[0]]?.x ?? [];
  const rows = Array.from(grid, (time, k) => [
    numberText(time, 9), ...names.map((name) => numberText(stop.curves[name].y[k] ?? NaN, 7)),
    ...valves.map((name) => stateText(stop.curves[name], time)),
  ]);
  return csvOf(stop, ["time, s", ...names.map((name) => `${name}, ${unitOf(name)}`), ...valves], rows);
};

const offerTables = (place, stop) => {
  const button = place.appendChild(make("button", "Save as CSV", { type: "button", "aria-label": `Save the samples of ${stop.id} as CSV` }));
  button.addEventListener("click", () => save(`${stop.id}.csv`, tableOf(stop)));
};
