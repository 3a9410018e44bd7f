/* The panels of a stop, and the strips between them. */
const common = first("#plots") ? json(first("#plots")) : { panels: [], loops: [], strips: [], quantities: {}, compared: [] };
const STATES = ["fill", "hold", "vent"];
const ROWS = [1, 2, 3, 4];

const wheelsetOf = (role) => Number(/^wheelset-([1-4])$/.exec(role)?.[1] ?? 0);
const inColumn = (wheelset, wheelsets) => !wheelset || wheelsets.includes(wheelset);

/* Line styles stand beside colours: a plot can be read in grey and by colour-blind eyes. */
const DASHES = {
  "wheelset-2": [7, 2], "wheelset-3": [3, 2], "wheelset-4": [8, 2, 2, 2],
  "brake-line": [14, 3], reservoir: [12, 2, 2, 2, 2, 2],
};

/* A line of a role in its colour; one that is `alone` in its panel needs no style of its own. */
const lineOf = (stop, axis, { label, role, series, dotted }, alone) => ({
  label, ink: role, width: role === "train" ? 2.2 : 1.3, dash: dotted ? [1, 2] : alone && wheelsetOf(role) ? [] : DASHES[role],
  x: axis.of(stop.curves[series]), y: stop.curves[series].y,
});

/* What the repeats of a stop span, behind the lines over time: over distance or speed they have no common moment. */
const bandsOf = ({ band }, axis, lines) =>
  (axis.name === "time" ? lines : [])
    .map(({ role, series }) => ({ ink: role, edges: ["lowest", "highest"].map((end) => band[`${end} ${series}`]) }))
    .filter(({ edges: [lowest] }) => lowest);

/* When the valve of a wheelset is in one of some states; such states that follow at once are one span. */
const spansOf = (stop, n, wanted) => {
  const { x, y } = stop.curves[`valve_command_${n}`] ?? { x: [], y: [] };
  const spans = [];
  y.forEach((value, k) => {
    const to = x[k + 1] ?? stop.end;
    if (!wanted.includes(Math.round(value))) return;
    if (spans.length && spans.at(-1)[1] === x[k]) spans.at(-1)[1] = to;
    else spans.push([x[k], to]);
  });
  return spans;
};

const magnetBars = (stop, axis, { label, offset, states }, n, row, ink = `wheelset-${n}`, half = 0.17) => ({
  spans: spansOf(stop, n, states).map((span) => span.map(axis.at)), row: row + offset, half, ink, opacity: label === "hold" ? 0.6 : 1,
});

/* The bars of some wheelsets: each in its row, or where they stand `apart` in the only one. */
const stripBars = (stop, axis, marks, { key, lanes }, wheelsets, apart, hidden) => {
  const rowOf = (n) => (apart ? 1 : n);
  const magnets = wheelsets.filter((n) => !hidden.has(`wheelset-${n}`))
    .flatMap((n) => lanes.map((lane) => magnetBars(stop, axis, lane, n, rowOf(n))));
  const intervals = marks
    .filter((mark) => mark.plot === key && mark.kind === "interval" && wheelsets.includes(mark.y))
    .map((mark) => ({ spans: [[mark.x0, mark.x1]], row: rowOf(mark.y), half: 0.46, ink: MARK_COLOURS[mark.status] + (lanes.length ? "-wash" : "") }));
  return [...intervals, ...magnets].filter(({ spans }) => spans.length);
};

/* Marks of a plot in a column: what belongs to another wheelset is left out; common labels stand once. */
const marksIn = (marks, key) => (wheelsets, column) =>
  marks
    .filter((mark) => mark.plot === key && inColumn(mark.wheelset, wheelsets))
    .map((mark) => (column && !mark.wheelset ? { ...mark, label: "" } : mark));

const stripRow = (stop, axis, marks, strip, apart, hidden) => {
  const rows = !apart ? strip.rows : strip.lanes.map((lane) => [1 + lane.offset, lane.label]);
  return {
    key: strip.key, title: strip.idle ? `${strip.title}: no command in this stop` : strip.heading, height: Math.max(apart ? 30 : 72, 13 * rows.length),
    ticks: new Map(rows), ruled: strip.lanes.length > 0, range: apart ? [0.5, 1.5] : [0.5, 4.5], include: [],
    lines: () => [], marks: marksIn(marks, strip.key),
    bars: (wheelsets) => stripBars(stop, axis, marks, strip, wheelsets, apart, hidden),
  };
};

/* Panels with the strips below each of them, then the other strips; those with nothing to show left out, but not valves without a command. */
const rowsOf = (stop, axis, apart, hidden) => {
  const marks = marksOn(stop, axis);
  const strips = common.strips
    .map((strip) => ({ ...strip, idle: !stripBars(stop, axis, marks, strip, ROWS, false, new Set()).length }))
    .filter(({ idle, lanes }) => !idle || (lanes.length && ROWS.some((n) => stop.curves[`valve_command_${n}`])))
    .map((strip) => [strip.below, stripRow(stop, axis, marks, strip, apart, hidden)]);
  const shownLines = (panel, wheelsets) =>
    panel.lines.filter((each) => each.series in stop.curves && inColumn(wheelsetOf(each.role), wheelsets) && !hidden.has(each.role));
  const rows = stop.panels
    .filter((panel) => panel.lines.some((each) => each.series in stop.curves))
    .flatMap((panel) => [
      {
        key: panel.key, title: titleOf(panel), height: 112 * panel.height, include: panel.include,
        lines: (wheelsets) => shownLines(panel, wheelsets).map((each) => lineOf(stop, axis, each, apart)),
        bands: (wheelsets) => (hidden.has("band") ? [] : bandsOf(stop, axis, shownLines(panel, wheelsets))),
        marks: marksIn(marks, panel.key),
      },
      ...strips.filter(([below]) => below === panel.key).map(([, row]) => row),
    ]);
  return [...rows, ...strips.map(([, row]) => row).filter((row) => !rows.includes(row))];
};

const figureOf = (stop, axis, apart, hidden) => ({
  rows: rowsOf(stop, axis, apart, hidden), columns: apart ? ROWS.map((n) => [n]) : [ROWS], start: axis.start, end: axis.end, across: axis,
});
