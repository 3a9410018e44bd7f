/* Bars in the rows of wheelsets: magnets of valves, and intervals that decided a criterion.
 * Bars as one filled line with gaps: a shape each would take seconds. Its edge keeps the shortest in sight. */
const bars = (kind, spans, fill, half, extra) => ({
  type: "scatter", mode: "lines", fill: "toself", fillcolor: fill, line: { color: fill, width: 1, simplify: false },
  x: spans.flatMap(([from, to]) => [from, to, to, from, from, null]),
  y: spans.flatMap(([, , row]) => [row - half, row - half, row + half, row + half, row - half, null]),
  hoverinfo: "skip", name: kind, ...extra,
});

/* When the valve of a wheelset is in one of some states; such states that follow at once are one span. */
const spansOf = (stop, n, wanted) => {
  const { x, y } = stop.curves[`valve_command_${n}`] ?? { x: [], y: [] };
  const spans = [];
  Array.from(y, Math.round).forEach((state, k) => {
    const to = x[k + 1] ?? stop.end;
    if (!wanted.includes(state)) return;
    if (spans.length && spans.at(-1)[1] === x[k]) spans.at(-1)[1] = to;
    else spans.push([x[k], to]);
  });
  return spans;
};

const magnetBars = (stop, { label, offset, states }, n, row, role = `wheelset-${n}`, half = 0.17) => {
  const spans = spansOf(stop, n, states).map((span) => [...span, row + offset]);
  const extra = { meta: role, opacity: label === "hold" ? 0.6 : 1 };
  return bars(label, spans, colour(role), half, extra);
};

/* The bars of some wheelsets: each in its row, or where they stand `apart` in the only one. */
const stripBars = (stop, { key, lanes }, wheelsets, apart = false) => {
  const rowOf = (n) => (apart ? 1 : n);
  const magnets = wheelsets.flatMap((n) => lanes.map((lane) => magnetBars(stop, lane, n, rowOf(n))));
  const marked = stop.marks.filter((mark) => mark.plot === key && mark.kind === "interval" && wheelsets.includes(mark.y));
  const kinds = [...new Set(marked.map((mark) => mark.status))];
  const intervals = kinds.map((status) => {
    const own = marked.filter((mark) => mark.status === status);
    const ink = colour(MARK_COLOURS[status] + (lanes.length ? "-wash" : ""));
    return bars("interval", own.map((mark) => [mark.x0, mark.x1, rowOf(mark.y)]), ink, 0.46);
  });
  return [...intervals, ...magnets].filter((each) => each.x.length);
};
