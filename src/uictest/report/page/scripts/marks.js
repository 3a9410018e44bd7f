/* Criteria in the plots: limits, instants, windows. Their labels stand above a panel, where no data lie. */
const MARK_COLOURS = { pass: "good", fail: "bad", inconclusive: "odd", not_applicable: "quiet" };
const inkOf = (mark) => colour(MARK_COLOURS[mark.status]);

const shapeOf = (mark, xref, yref) => {
  const x0 = mark.x0 ?? 0;
  const x1 = mark.x1 ?? 1;
  const across = mark.x0 === null && mark.x1 === null ? `${xref} domain` : xref;
  const upright = { xref: across, yref: `${yref} domain`, x0, x1, y0: 0, y1: 1 };
  if (mark.kind === "instant") return { type: "line", ...upright, line: { color: inkOf(mark), width: 2 } };
  if (mark.kind === "tolerance")
    return { type: "rect", layer: "below", xref: `${xref} domain`, yref, x0: 0, x1: 1, y0: -mark.y, y1: mark.y,
             line: { width: 0 }, fillcolor: colour(`${MARK_COLOURS[mark.status]}-wash`) };
  if (mark.y === null)
    return { type: "rect", layer: "below", ...upright, opacity: 0.75, line: { width: 0 },
             fillcolor: colour(mark.kind === "window" && mark.status === "fail" ? "bad-wash" : "window") };
  return { type: "line", xref: across, yref, x0, x1, y0: mark.y, y1: mark.y,
           line: { color: inkOf(mark), width: mark.kind === "mean" ? 2.6 : 1.5,
                   dash: mark.kind === "mean" ? "solid" : "dash" } };
};

const pointOf = (mark, xaxis, yaxis) => ({
  type: "scatter", mode: "markers", cliponaxis: false, x: [mark.x0], y: [mark.y], xaxis, yaxis, hoverinfo: "none", name: mark.criterion,
  marker: { symbol: "circle-open", size: 10, color: inkOf(mark), line: { width: 2 } },
});

/* An open end of a mark is the end of the record, so that zooming keeps it in its place. */
const closedMarks = (stop) =>
  stop.marks.map((mark) =>
    mark.y !== null && (mark.x0 === null) !== (mark.x1 === null)
      ? { ...mark, x0: mark.x0 ?? stop.start, x1: mark.x1 ?? stop.end }
      : mark,
  );

const CHARACTER = 6.3; /* pixels of a letter of a label, about */
const LABEL_ROW = 14;
const SAMPLES = { limit: "┄ ", mean: "━ ", tolerance: "▬ " };
const widthOf = (text) => CHARACTER * text.length + 8;
const shortened = (text, width) =>
  widthOf(text) <= width ? text : `${text.slice(0, Math.max(Math.floor((width - 8) / CHARACTER) - 1, 1))}…`;

/* Title and labels in rows above a panel, none over another. `pixel` gives the place of an x in the panel. */
const labelRows = (title, marks, width, pixel) => {
  const rows = [[{ text: title, left: 0, right: widthOf(title) * 1.08 }]];
  const free = (row, left, right) => row.every((each) => right <= each.left || left >= each.right);
  for (const mark of marks.filter((each) => each.label)) {
    const text = shortened((SAMPLES[mark.kind] ?? "") + mark.label, width);
    const own = widthOf(text);
    const left = Math.max(0, Math.min(pixel(mark.x0 ?? mark.x1 ?? Infinity), width - own));
    let row = rows.findIndex((each) => free(each, left, left + own));
    if (row < 0) row = rows.push([]) - 1;
    rows[row].push({ text, left, right: left + own, mark });
  }
  return rows;
};

const labelsAbove = (rows, width, x, y) =>
  rows.flatMap((row, k) =>
    row.map(({ text, left, mark }) => ({
      text: plain(text), xref: `${x} domain`, yref: `${y} domain`, x: left / width, y: 1, xanchor: "left",
      yanchor: "bottom", yshift: 2 + LABEL_ROW * (rows.length - 1 - k), showarrow: false,
      font: { size: mark ? 11 : 12, color: mark ? inkOf(mark) : colour("ink") },
    })),
  );
