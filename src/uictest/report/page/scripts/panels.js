/* Rows of panels over one time axis, in one column or in one for each wheelset.
 *
 * A row has a `title`, a `height` in pixels, the settings of its upright axis and, for the wheelsets of a
 * column, its traces and its marks. */
const MARGIN = { l: 44, r: 8, b: 40 };
const COLUMN_GAP = 12;
const MODEBAR = 22; /* pixels above the panels, so that it covers no label */
const subplot = (letter, number) => (number > 1 ? `${letter}${number}` : letter);

/* Where the columns lie, in shares of the width, and how many pixels one of them has. */
const columnsOf = (count, width) => {
  const inner = width - MARGIN.l - MARGIN.r;
  const gap = (COLUMN_GAP * (count - 1)) / inner;
  const share = (1 - gap) / count;
  return { pixels: inner * share, domains: Array.from({ length: count }, (_, c) => {
    const from = c * (share + COLUMN_GAP / inner);
    return [from, Math.min(from + share, 1)];
  }) };
};

/* What the upright axis of a row spans: all values in all columns, and what its settings include. */
const AIR = 0.05;
const spanOf = (traces, marks, include) => {
  let [low, high] = [Infinity, -Infinity];
  const add = (value) => {
    if (value === null || !Number.isFinite(value)) return;
    low = Math.min(low, value);
    high = Math.max(high, value);
  };
  for (const trace of traces) trace.y.forEach(add);
  for (const mark of marks) add(mark.y);
  include.forEach(add);
  const air = AIR * (high - low) || 1;
  return low <= high ? [low - air, high + air] : [0, 1];
};

/* Without any trace a panel would be left out. */
const NOTHING = { type: "scatter", mode: "lines", x: [0], y: [null], hoverinfo: "skip" };

const gridFigure = ({ rows, columns, width, start, end, across = "time since the brake command, s" }) => {
  const { pixels, domains } = columnsOf(columns.length, width);
  const pixel = (time) => (Math.min(Math.max(time, start), end) - start) / (end - start || 1) * pixels;
  const marks = rows.map((row) => columns.map((wheelsets, c) => row.marks?.(wheelsets, c) ?? []));
  const labels = rows.map((row, r) =>
    columns.map((_, c) => labelRows(c ? "" : row.title, marks[r][c], pixels, pixel)));
  const gaps = labels.map((own) => 12 + LABEL_ROW * Math.max(...own.map((each) => each.length)));
  const apart = columns.length > 1;
  const over = apart ? 18 : 0;
  const total = rows.reduce((sum, { height }, r) => sum + height + gaps[r], over);
  const traces = [];
  const layout = { shapes: [], annotations: [] };
  let top = 1 - over / total;
  rows.forEach((row, r) => {
    const upper = top - gaps[r] / total;
    top = Math.max(upper - row.height / total, 0);
    const drawn = columns.map((wheelsets) => row.traces(wheelsets, apart));
    for (const cell of drawn) if (!cell.length) cell.push(NOTHING);
    const { range = spanOf(drawn.flat(), marks[r].flat(), row.include ?? []), ...settings } = row.yaxis;
    columns.forEach((wheelsets, c) => {
      const number = r * columns.length + c + 1;
      const [x, y] = [subplot("x", c + 1), subplot("y", number)];
      traces.push(...drawn[c].map((trace) => ({ ...trace, xaxis: x, yaxis: y })));
      layout[`yaxis${number > 1 ? number : ""}`] = axis({
        domain: [top, upper], anchor: x, range, ...settings, ...(c ? { matches: subplot("y", number - c), showticklabels: false } : {}),
      });
      for (const mark of marks[r][c]) {
        if (mark.kind === "point") traces.push(pointOf(mark, x, y));
        else if (mark.kind !== "interval") layout.shapes.push(shapeOf(mark, x, y));
      }
      layout.annotations.push(...labelsAbove(labels[r][c], pixels, x, y));
    });
  });
  columns.forEach((wheelsets, c) => {
    const last = (rows.length - 1) * columns.length + c + 1;
    layout[`xaxis${c ? c + 1 : ""}`] = axis({
      domain: domains[c], anchor: subplot("y", last), range: [start, end], ...(c ? { matches: "x" } : {}), nticks: apart ? 5 : 10,
      title: { text: c ? "" : across, font: { size: 11, color: colour("quiet") }, standoff: 6 },
    });
    if (apart)
      layout.annotations.push({ text: `wheelset ${wheelsets[0]}`, xref: `${subplot("x", c + 1)} domain`, yref: "paper", x: 0, y: 1,
        xanchor: "left", yanchor: "top", showarrow: false, font: { size: 12, color: colour("ink"), weight: 600 } });
  });
  return { traces, layout: frame({ ...layout, height: total + MARGIN.b + MODEBAR, hovermode: "x", hoverdistance: -1,
    dragmode: "zoom", margin: { ...MARGIN, t: MODEBAR } }) };
};

/* Panels with the strips below each of them, then the other strips; those with nothing to show left out. */
const plotsOverTime = (stop) => {
  const strips = common.strips.filter((strip) => stripBars(stop, strip, ROWS).length);
  const under = (panel) => strips.filter((strip) => strip.below === panel.key);
  const shown = (panel) => panel.lines.some((each) => each.series in stop.curves);
  const placed = stop.panels.flatMap((panel) => [...(shown(panel) ? [panel] : []), ...under(panel)]);
  return [...placed, ...strips.filter((strip) => !placed.includes(strip))];
};

const wheelsetOf = (role) => Number(/^wheelset-([1-4])$/.exec(role)?.[1] ?? 0);
const inColumn = (wheelset, wheelsets) => !wheelset || wheelsets.includes(wheelset);

/* Marks of a plot in a column: what belongs to another wheelset is left out; common labels stand once. */
const marksIn = (marks, key) => (wheelsets, c) =>
  marks
    .filter((mark) => mark.plot === key && inColumn(mark.wheelset, wheelsets))
    .map((mark) => (c && !mark.wheelset ? { ...mark, label: "" } : mark));

const panelRow = (stop, marks, panel) => ({
  title: `${panel.title}, ${panel.unit}`,
  height: 112 * panel.height,
  yaxis: { nticks: 5 },
  include: panel.include,
  traces: (wheelsets, apart) =>
    panel.lines
      .filter((each) => each.series in stop.curves && inColumn(wheelsetOf(each.role), wheelsets))
      .map((each) => line(each, stop.curves[each.series], apart)),
  marks: marksIn(marks, panel.key),
});

const stripRow = (stop, marks, strip, apart) => {
  const rows = apart ? (strip.lanes.length ? strip.lanes.map((lane) => [1 + lane.offset, lane.label]) : []) : strip.rows;
  return {
    title: strip.heading,
    height: Math.max(apart ? 26 : 72, 13 * rows.length),
    yaxis: {
      fixedrange: true, tickvals: rows.map(([row]) => row), ticktext: rows.map(([, label]) => label),
      range: apart ? [1.5, 0.5] : [4.5, 0.5], showgrid: strip.lanes.length > 0,
    },
    traces: (wheelsets) => stripBars(stop, strip, wheelsets, apart),
    marks: marksIn(marks, strip.key),
  };
};

const panelsFigure = (stop, width, apart = false) => {
  const marks = closedMarks(stop);
  const rows = plotsOverTime(stop).map((plot) =>
    plot.lines ? panelRow(stop, marks, plot) : stripRow(stop, marks, plot, apart));
  const columns = apart ? ROWS.map((n) => [n]) : [ROWS];
  return gridFigure({ rows, columns, width, start: stop.start, end: stop.end });
};
