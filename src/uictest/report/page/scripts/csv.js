/* The points behind a plot as a file: a row for each point of each line. */
const numberText = (value, digits) => (Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : "");
const cellText = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const csvLines = (rows) => rows.map((row) => `${row.map(cellText).join(",")}\n`).join("");

const csvOf = (stop, title, head, points) =>
  `# case: ${stop.id}\n# plot: ${title}\n# sampling: ${stop.sampling}\n${csvLines([head, ...points])}`;

const labelOfSeries = (name) => {
  const [, key, wheelset] = /^(.*?)(?:_([1-4]))?$/.exec(name);
  const quantity = common.quantities[key] ?? { label: name, unit: "" };
  return [wheelset ? `${quantity.label} of wheelset ${wheelset}`.replace("wheelset of ", "") : quantity.label, quantity.unit];
};

const pointsOverTime = (stop, names) =>
  names.flatMap((name) => {
    const { x, y } = stop.curves[name];
    const [label, unit] = labelOfSeries(name);
    const value = name.startsWith("valve_command") ? (state) => STATES[Math.round(state)] ?? "" : (v) => numberText(v, 7);
    return Array.from(x, (time, k) => [label, unit, numberText(time, 9), value(y[k])]);
  });

const pointsOfLoop = (stop, loop) =>
  loop.lines
    .map((each) => [each, stop.loops[`${loop.key} ${each.series}`]])
    .filter(([, curve]) => curve)
    .flatMap(([each, { x, y }]) => Array.from(x, (across, k) => [each.label, numberText(across, 7), numberText(y[k], 7)]));

const save = (name, text) => {
  const link = make("a", "", { download: name, href: URL.createObjectURL(new Blob([text], { type: "text/csv" })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
};

/* What can be downloaded of a stop: name of the file, title of the plot, and its text when it is asked for. */
const tablesOf = (stop) => {
  const states = ROWS.map((n) => `valve_command_${n}`);
  const over = ["line", "unit", "time_s", "value"];
  const panels = [
    ...stop.panels.map(({ key, title, lines }) => [key, title, lines.map((each) => each.series)]),
    ["valves", "WSP valves", states],
  ]
    .map(([key, title, names]) => [key, title, names.filter((name) => name in stop.curves)])
    .filter(([, , names]) => names.length)
    .map(([key, title, names]) => [key, title, () => csvOf(stop, title, over, pointsOverTime(stop, names))]);
  const loops = loopsIn(stop).map((loop) => {
    const head = ["line", ...[loop.across_title, loop.up_title].map((title) => title.replace(", ", "_"))];
    return [loop.key, loop.title, () => csvOf(stop, loop.title, head, pointsOfLoop(stop, loop))];
  });
  return [...panels, ...loops];
};

const offerTables = (place, stop) => {
  for (const [key, title, text] of tablesOf(stop)) {
    const button = make("button", title.replace(/ \(.*\)/, ""), { type: "button", "aria-label": `Download ${title} as CSV` });
    button.addEventListener("click", () => save(`${stop.id} ${key}.csv`, text()));
    place.append(button);
  }
};
