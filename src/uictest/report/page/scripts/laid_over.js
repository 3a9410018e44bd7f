/* Two sides of a stop over each other, their difference beneath, over time or over distance: drawn once they
 * come near the window, with one cursor for all panels and the table. */
const SIDE_STYLES = { "side-a": ["compared-1", []], "side-b": ["compared-2", [6, 2]], difference: ["train", []] };
const SIDE_LINES = ["first", "second", "difference"];

const sideRow = ({ curves, marks }, panel) => ({
  key: panel.key, title: titleOf(panel), height: 112 * panel.height, include: panel.include,
  lines: () => panel.lines.filter((each) => each.series in curves).map(({ label, role, series }) => {
    const [ink, dash] = SIDE_STYLES[role];
    return { label, ink, dash, width: 1.5, ...curves[series] };
  }),
  marks: () => marks.filter((mark) => mark.plot === panel.key),
});

/* A value of a line; none beyond its ends. */
const valueWithin = (curve, at) =>
  curve && at >= curve.x[0] && at <= curve.x.at(-1) ? valueAt(curve, at) : NaN;

/* As many decimals as the points have: they are rounded to a part of the range of their line. */
const decimalsOf = (curve) => {
  const known = (curve?.y ?? []).filter(Number.isFinite);
  const range = known.reduce((most, value) => Math.max(most, value), -Infinity) - known.reduce((least, value) => Math.min(least, value), Infinity);
  return range > 0 ? Math.min(Math.max(4 - Math.floor(Math.log10(range)), 0), 9) : 3;
};
const MOST_PERCENT = 1000; /* beyond, a relative figure says only that its base is nearly 0 */
const percentText = (value, base) => {
  if (!base || !Number.isFinite(value / base)) return "–";
  const percent = (100 * value) / Math.abs(base);
  if (Math.abs(percent) >= MOST_PERCENT) return percent > 0 ? `> ${MOST_PERCENT}` : `< -${MOST_PERCENT}`;
  return String(Number(percent.toPrecision(3)));
};

/* What the cells of a channel read at the cursor. */
const cursorCells = (row) => {
  const { channel, relative } = row.dataset;
  const cells = all("td.number", row);
  return ({ curves }, at) => {
    const lines = SIDE_LINES.map((name) => curves[`${name} ${channel}`]);
    const [a, b, apart] = lines.map((curve) => valueWithin(curve, at));
    const decimals = decimalsOf(lines[0]);
    const figures = [a, b, apart].map((value) => text(value, decimals));
    const shown = Number(figures[0]); /* A is 0 where it reads as 0. */
    [...figures, relative === "yes" ? percentText(apart, shown && a) : "–"].forEach((own, k) => {
      cells[k].textContent = own;
    });
  };
};

const abscissae = async (stop) => {
  const drawnIn = (curves) => stop.panels.filter((panel) => panel.lines.some((each) => each.series in curves));
  const views = { time: { curves: stop.curves, marks: stop.marks, start: stop.start, end: stop.end,
    title: "time since the brake command, s", head: "time_s", unit: "s", panels: drawnIn(stop.curves) } };
  const curves = await unpacked(stop.over_distance);
  const drawn = Object.values(curves).filter(({ x }) => x.length);
  if (drawn.length)
    views.distance = { curves, marks: stop.marks_over_distance, start: Math.min(...drawn.map(({ x }) => x[0])),
      end: Math.max(...drawn.map(({ x }) => x.at(-1))), title: "distance since the brake command, m", head: "distance_m",
      unit: "m", panels: drawnIn(curves) };
  return views;
};

/* The three lines of every channel, each over its own points. */
const sideTable = (stop, { curves, head, panels }) => {
  const rows = panels.filter((panel) => panel.lines.length > 1).flatMap(({ quantities: [channel], unit }) =>
    SIDE_LINES.flatMap((name, k) => {
      const { x, y } = curves[`${name} ${channel}`] ?? { x: [], y: [] };
      return Array.from(x, (at, row) => [channel, ["A", "B", "B - A"][k], unit, numberText(at, 9), numberText(y[row] ?? NaN, 7)]);
    }));
  return csvOf(stop, ["channel", "line", "unit", head, "value"], rows);
};

const drawSides = async (plots) => {
  const stop = await stopOf(plots.nextElementSibling);
  const views = await abscissae(stop);
  const panels = first(".panels-plot", plots);
  const slider = first(".slider input", plots);
  const cells = all(".at-cursor tbody tr", plots).map(cursorCells);
  const shown = () => chosen(plots, "across") || "time";
  const view = viewer(panels, { moved: (x) => show(x), pinned: () => {} });
  const paint = () => {
    const { curves, marks, start, end, title, panels: own } = views[shown()];
    const rows = own.map((panel) => sideRow({ curves, marks }, panel));
    view.paint({ rows, columns: [ROWS], start, end, across: { title, tick: (x) => x } });
    if (at !== null) show(at);
  };
  let at = null;
  panels.hidden = false;
  for (const each of all(".drawing", plots)) each.hidden = true;
  const show = (wanted) => {
    const own = views[shown()];
    at = Math.max(own.start, Math.min(wanted, own.end));
    slider.value = (slider.max * (at - own.start)) / (own.end - own.start || 1);
    slider.setAttribute("aria-valuetext", `${text(at, 2)} ${own.unit}`);
    first(".slider output", plots).textContent = `${text(at, 2)} ${own.unit}`;
    for (const read of cells) read(own, at);
    view.show("cursor-line", at);
  };
  paint();
  redraw.push(paint);
  slider.addEventListener("input", () => {
    const { start, end } = views[shown()];
    show(start + (slider.value / slider.max) * (end - start));
  });
  offerZoom(first(".zoom", plots), view);
  const choice = first('[data-choice="across"]', plots);
  choice?.addEventListener("change", () => {
    at = views[shown()].start;
    paint();
  });
  for (const button of all("button.moment", plots))
    button.addEventListener("click", () => {
      at = Number(button.dataset.at);
      if (choice && choice.value !== "time") {
        choice.value = "time";
        paint();
      }
      if (at < view.inView()[0] || at > view.inView()[1]) view.all();
      show(at);
      panels.scrollIntoView({ block: "nearest" });
    });
  const button = first(".tables", plots).appendChild(make("button", "Save as CSV", { type: "button", "aria-label": `Save the points of ${stop.id} as CSV` }));
  button.addEventListener("click", () => save(`${stop.id}.csv`, sideTable(stop, views[shown()])));
  show(Number(first("button.moment", plots)?.dataset.at ?? stop.start));
  plots.dataset.ready = "yes";
};

if (canPlot) {
  const near = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target: plots } of entries)
      if (isIntersecting) {
        near.unobserve(plots);
        drawSides(plots);
      }
  }, { rootMargin: "600px" });
  for (const plots of all(".plots.laid-over")) near.observe(plots);
}
