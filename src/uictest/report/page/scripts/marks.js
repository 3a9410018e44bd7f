/* Criteria in the plots: limits, instants, windows, bars. Their labels stand above a panel, where no data lie. */
const MARK_COLOURS = { pass: "good", fail: "bad", inconclusive: "odd", not_applicable: "quiet" };
const MARKS_BELOW = ["window", "band", "tolerance", "fault"];
const MARKS_ABOVE = ["limit", "mean", "instant", "point"];

/* Heights that an upright axis must include for the marks in it. */
const heightsOf = (marks) => marks.flatMap(({ kind, y }) => (y === null || kind === "interval" ? [] : kind === "tolerance" ? [-y, y] : [y]));

const clipped = (plot, draw) => {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  draw(ctx, bbox, (x) => plot.valToPos(x, "x", true), (y) => plot.valToPos(y, "y", true), devicePixelRatio);
  ctx.restore();
};

/* What was injected has a pattern of its own, apart from what is judged and from what the reader chose. */
const hatch = (ctx, left, right, { top, height }, pixel) => {
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, height);
  ctx.clip();
  ctx.strokeStyle = colour("fault");
  ctx.lineWidth = pixel;
  ctx.globalAlpha = 0.35;
  ctx.beginPath();
  for (let x = left - height; x < right; x += 9 * pixel) {
    ctx.moveTo(x, top + height);
    ctx.lineTo(x + height, top);
  }
  ctx.stroke();
  ctx.restore();
  ctx.beginPath();
};

/* An open end of a mark is the end of the record. */
const paintMarks = (plot, marks, kinds) => {
  const own = marks.filter((mark) => kinds.includes(mark.kind));
  if (!own.length) return;
  clipped(plot, (ctx, bbox, across, up, pixel) => {
    for (const { kind, status, x0, x1, y } of own) {
      const [left, right] = [x0 === null ? bbox.left : across(x0), x1 === null ? bbox.left + bbox.width : across(x1)];
      ctx.setLineDash(kind === "limit" ? [6 * pixel, 4 * pixel] : []);
      ctx.lineWidth = { limit: 1.5, mean: 2.6 }[kind] * pixel || 2 * pixel;
      ctx.strokeStyle = colour(MARK_COLOURS[status]);
      ctx.fillStyle = kind === "tolerance" ? colour(`${MARK_COLOURS[status]}-wash`) : colour(kind === "window" && status === "fail" ? "bad-wash" : "window");
      ctx.globalAlpha = kind === "window" || kind === "band" ? 0.75 : 1;
      ctx.beginPath();
      if (kind === "tolerance") ctx.fillRect(bbox.left, up(y), bbox.width, up(-y) - up(y));
      else if (kind === "fault") hatch(ctx, left, right, bbox, pixel);
      else if (MARKS_BELOW.includes(kind)) ctx.fillRect(left, bbox.top, right - left, bbox.height);
      else if (kind === "point") ctx.arc(left, up(y), 4.5 * pixel, 0, 2 * Math.PI);
      else if (kind === "instant") {
        ctx.moveTo(left, bbox.top);
        ctx.lineTo(left, bbox.top + bbox.height);
      } else {
        ctx.moveTo(left, up(y));
        ctx.lineTo(right, up(y));
      }
      ctx.stroke();
    }
  });
};

/* Bars in rows: `spans` of x, in the row `row`, `half` of one high to each side; the shortest stays in sight. */
const paintBars = (plot, { spans, row, half, ink, opacity = 1 }) =>
  clipped(plot, (ctx, bbox, across, up, pixel) => {
    ctx.fillStyle = colour(ink);
    ctx.globalAlpha = opacity;
    const [top, bottom] = [up(row - half), up(row + half)];
    for (const [from, to] of spans) {
      const left = Math.round(across(from));
      ctx.fillRect(left, Math.min(top, bottom), Math.max(across(to) - left, pixel), Math.abs(bottom - top));
    }
  });

const CHARACTER = 6.3; /* pixels of a letter of a label, about */
const SAMPLES = { limit: "┄ ", mean: "━ ", tolerance: "▬ ", fault: "▨ " };
const BOLD = 1.08; /* width of a letter of a title over that */
const widthOf = (text) => CHARACTER * text.length + 8;
const shortened = (text, width) =>
  widthOf(text) <= width ? text : `${text.slice(0, Math.max(Math.floor((width - 8) / CHARACTER) - 1, 1))}…`;

const titleOf = ({ title, unit }) => (unit === "dimensionless" ? title : `${title}, ${unit}`);

/* Title and labels in rows above a panel, none over another. `pixel` gives the place of an x in the panel. */
const labelsAbove = (title, marks, width, pixel) => {
  const rows = [[{ text: shortened(title, width / BOLD), left: 0, right: widthOf(title) * BOLD }]];
  const free = (row, left, right) => row.every((each) => right <= each.left || left >= each.right);
  for (const mark of marks.filter((each) => each.label)) {
    const text = shortened((SAMPLES[mark.kind] ?? "") + mark.label, width);
    const own = widthOf(text);
    const left = Math.max(0, Math.min(pixel(mark.x0 ?? mark.x1 ?? Infinity), width - own));
    let row = rows.findIndex((each) => free(each, left, left + own));
    if (row < 0) row = rows.push([]) - 1;
    rows[row].push({ text, left, right: left + own, mark });
  }
  return rows.map((row) => {
    const line = make("div", "", { class: "label-row" });
    for (const { text, left, mark } of row) {
      const label = line.appendChild(make("span", text, { class: mark ? `mark mark-${mark.kind === "fault" ? "fault" : mark.status}` : "plot-title" }));
      label.style.left = `${left}px`;
    }
    return line;
  });
};
