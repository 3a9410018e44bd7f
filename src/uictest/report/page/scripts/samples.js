/* Samples of a stop: as they come with the page, as texts at a time, and as a file. */
const MISSING = 32767;

const bytesOf = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
const inflated = (text) =>
  new Response(new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate")));

/* Lines as `stop_plots.py` packs them; those over one grid share the array of its x. A missing value is null. */
const unpacked = async ({ grids, lines, data }) => {
  const bytes = new Uint8Array(await inflated(data).arrayBuffer());
  const half = bytes.length / 2;
  let at = 0;
  const values = (count, [offset, step], missing = NaN) => {
    let sum = 0;
    const found = new Array(count);
    for (let k = 0; k < count; k += 1, at += 1) {
      sum += ((bytes[at] | (bytes[at + half] << 8)) << 16) >> 16;
      found[k] = sum === missing ? null : offset + step * sum;
    }
    return found;
  };
  const across = grids.map(({ count, scale }) => Float64Array.from(values(count, scale)));
  const curves = Object.entries(lines).map(([name, { grid, scale }]) => [name, { x: across[grid], y: values(across[grid].length, scale, MISSING) }]);
  return Object.fromEntries(curves);
};

/* A mark comes without what it usually has. */
const MARK = { label: "", x0: null, x1: null, y: null, wheelset: null, criterion: "", status: "pass", along: "time" };

const stopOf = async (element) => {
  const { over_time, band, panels = common.panels, marks, ...rest } = json(element);
  return { ...rest, panels, marks: marks.map((mark) => ({ ...MARK, ...mark })), curves: await unpacked(over_time), band: band ? await unpacked(band) : {} };
};

/* Values of a stop at a time, as texts. */
const text = (value, decimals) =>
  Number.isFinite(value) ? value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1") : "–";

/* The row of the last x that is not behind a time. */
const rowAt = (x, time) => {
  let low = 0;
  let high = x.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
};

const stateAt = (curve, time) => (curve ? curve.y[rowAt(curve.x, time)] : NaN);
const stateText = (curve, time) => STATES[Math.round(stateAt(curve, time))] ?? "–";

/* The height of a line as it is drawn, NaN in a gap; beyond its end it stays at its last point. */
const valueAt = (curve, time) => {
  if (!curve) return NaN;
  const { x, y } = curve;
  const k = rowAt(x, time);
  const [from, to] = [y[k] ?? NaN, y[k + 1] ?? NaN];
  if (k + 1 >= x.length || time <= x[k]) return from;
  return from + ((time - x[k]) / (x[k + 1] - x[k])) * (to - from);
};

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
