/* Panels above each other over one x axis, in one column or in one for each wheelset. Every panel is a canvas of
 * its own; the range in view, the cursors, the band and the ring are common to all.
 *
 * A figure has `rows`, `columns` (the wheelsets of each), `start`, `end` and `across` (`title` and `tick`, the text
 * of a value on the axis). A row has a `key`, a `title`, a `height` in pixels, the values that its upright axis
 * must `include` or the `range` of the rows, from the top, that its `ticks` name, and for the wheelsets of a column its
 * `lines`, its `marks` and, if any, the `bands` behind the lines, between two edges, and the bars that it lays over them. */
const canPlot = Boolean(window.uPlot && window.DecompressionStream);
const LEFT = 46;
const RIGHT = 8;
const AXIS = 38;

/* A line as uPlot draws it: points are taken as they are, a missing one leaves a gap. */
const seriesOf = ({ label, ink, width = 1.3, dash = [] }) => ({
  label, stroke: colour(ink), width, dash, points: { show: false }, spanGaps: false,
});

/* The edges of bands are no lines of their own: they are drawn as what lies between them. */
const BAND_SHARE = 16; /* per cent of the colour of its line */
const edgesOf = (bands) => bands.flatMap(({ edges }) => edges);
const betweenEdges = ({ ink }, place) => ({ series: [2 * place + 2, 2 * place + 1], fill: () => colour(ink, BAND_SHARE) });

/* All lines over one x. Lines of several records, each over its own, are joined: between its points each goes on. */
const joined = (lines, start, end) => {
  if (!lines.length) return [[start, end], [null, null]];
  const tables = new Map();
  for (const { x, y } of lines) tables.set(x, [...(tables.get(x) ?? [x]), y]);
  if (tables.size === 1) return [...tables.values()][0];
  const placed = lines.map(({ x, y }) => [tables.get(x), y]);
  const all = uPlot.join([...tables.values()], [...tables.values()].map((table) => table.map(() => 2)));
  const order = [...tables.values()].flatMap((table) => table.slice(1).map((y) => [table, y]));
  return [all[0], ...placed.map(([table, y]) => all[1 + order.findIndex((each) => each[0] === table && each[1] === y)])];
};

const AIR = 0.05;
const withAir = (low, high) => {
  const air = AIR * (high - low) || Math.abs(high) * AIR || 1;
  return [low - air, high + air];
};

const extentOf = (y, from = 0, to = y.length) => {
  let [low, high] = [Infinity, -Infinity];
  for (let k = from; k < to; k += 1) {
    const value = y[k];
    if (value === null || !Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [];
};

const spanOf = (values) => (values.length ? withAir(Math.min(...values), Math.max(...values)) : [0, 1]);

const numbersOf = (plot, values, _axis, _space, step) => {
  const decimals = [0, 1, 2, 3, 4, 5, 6].find((each) => Math.abs(step * 10 ** each - Math.round(step * 10 ** each)) < 1e-6) ?? 6;
  return values.map((value) => text(value, decimals));
};
const nothing = (plot, values) => values.map(() => "");

const axisOf = (extra) => ({
  stroke: colour("quiet"), font: `11px ${getComputedStyle(document.body).fontFamily}`, gap: 4, labelGap: 0,
  grid: { stroke: colour("grid"), width: 1 }, ticks: { show: false }, border: { show: true, stroke: colour("rule"), width: 1 },
  ...extra,
});

const viewer = (element, { moved, pinned, ranged = () => {} }) => {
  let plots = [];
  let figure = null;
  let range = null; /* null: all of it. */
  const spans = new Map();
  let circle = null;

  const inView = () => range ?? [figure.start, figure.end];
  const marksInView = (marks) => {
    const [low, high] = inView();
    return marks.filter(({ x0, x1 }) => (x0 ?? low) <= high && (x1 ?? high) >= low);
  };

  const putSpan = ({ plot, cell }, kind) => {
    const span = spans.get(kind);
    const line = first(`.${kind}`, plot.over) ?? plot.over.appendChild(make("div", "", { class: kind }));
    const [low, high] = inView();
    line.hidden = !span || span[1] < low || span[0] > high;
    if (line.hidden) return;
    const [from, to] = span.map((x) => plot.valToPos(Math.min(Math.max(x, low), high), "x"));
    line.style.cssText = `left:${from}px;width:${Math.max(to - from, 1)}px;top:0;height:100%`;
  };
  const putRing = () => {
    const ring = first(".ring", element) ?? element.appendChild(make("div", "", { class: "ring" }));
    const of = circle && plots.find(({ row, wheelsets }) => row.key === circle.key && inColumn(circle.wheelset, wheelsets));
    ring.hidden = !of || circle.y === null;
    if (ring.hidden) return;
    const { plot } = of;
    const [left, top] = [plot.valToPos(circle.x, "x"), plot.valToPos(circle.y, "y")];
    ring.hidden = left < 0 || left > plot.over.clientWidth || top < 0 || top > plot.over.clientHeight;
    plot.over.append(ring);
    ring.style.cssText = `left:${left}px;top:${top}px`;
  };
  const put = () => {
    relabel();
    for (const each of plots) for (const kind of spans.keys()) putSpan(each, kind);
    putRing();
  };

  /* The range is put to every plot; one that has it already says nothing more. */
  const zoom = (low, high) => {
    const [all, least] = [figure.end - figure.start, (figure.end - figure.start) / 2000];
    const width = Math.min(Math.max(high - low, least), all);
    const from = Math.min(Math.max(low, figure.start), figure.end - width);
    range = width >= all ? null : [from, from + width];
    const [min, max] = inView();
    for (const { plot } of plots) plot.setScale("x", { min, max });
    queueMicrotask(put); /* uPlot takes a range in a microtask: until then pixels are those of the range before. */
    ranged(inView());
  };
  const followed = (plot) => {
    const { min, max } = plot.scales.x;
    const [low, high] = inView();
    if (figure.ready && (min !== low || max !== high)) zoom(min, max);
  };

  /* What the panels of a row span: the values and marks in view and, where all is in view, what is to be included. */
  const spanInView = (row) => {
    const [low, high] = inView();
    const values = plots.filter((each) => each.row === row).flatMap(({ data: [x, ...ys], marks }) => {
      return [...heightsOf(marksInView(marks)), ...ys.flatMap((y) => extentOf(y, rowAt(x, low), rowAt(x, high) + 1))];
    });
    return spanOf(range ? values : [...values, ...row.include]);
  };

  const relabel = () => {
    for (const { row, column, plot, labels, marks } of plots)
      if (labels) labels.replaceChildren(...labelsAbove(column ? "" : row.title, marksInView(marks), plot.over.clientWidth,
        (x) => plot.valToPos(Math.min(Math.max(x, inView()[0]), inView()[1]), "x")));
  };

  const hold = (plot) => {
    let pressed = null;
    plot.over.addEventListener("pointerdown", ({ offsetX }) => { pressed = offsetX; });
    plot.over.addEventListener("pointermove", ({ offsetX }) => moved(plot.posToVal(offsetX, "x")));
    plot.over.addEventListener("pointerup", ({ offsetX }) => {
      if (pressed !== null && Math.abs(offsetX - pressed) < 3) pinned(plot.posToVal(offsetX, "x"));
      pressed = null;
    });
  };

  const options = (row, column, width, { lines, bands, marks, bars }) => ({
    width, height: row.height, pxAlign: 0, padding: [3, RIGHT, 3, column ? RIGHT / 2 : 0], legend: { show: false },
    cursor: { x: false, y: false, points: { show: false }, drag: { x: true, y: false, dist: 5 },
      bind: { dblclick: () => () => zoom(figure.start, figure.end) } },
    scales: { x: { time: false }, y: row.range ? { range: () => row.range, dir: -1 } : { range: () => spanInView(row) } },
    axes: [
      axisOf({ values: nothing, size: 0 }),
      axisOf({ size: column ? 0 : LEFT, values: column ? nothing : row.ticks ? (_, at) => at.map((value) => row.ticks.get(value) ?? "") : numbersOf,
        ...(row.ticks ? { splits: () => [...row.ticks.keys()], grid: { show: row.ruled, stroke: colour("grid"), width: 1 } } : { space: 24 }) }),
    ],
    series: [{}, ...edgesOf(bands).map(() => ({ width: 0, points: { show: false } })), ...(lines.length ? lines.map(seriesOf) : [{ show: false }])],
    bands: bands.map(betweenEdges),
    hooks: {
      drawAxes: [(plot) => paintMarks(plot, marks, MARKS_BELOW)],
      draw: [(plot) => {
        for (const each of bars) paintBars(plot, each);
        paintMarks(plot, marks, MARKS_ABOVE);
      }],
      setScale: [(plot, key) => key === "x" && followed(plot)],
    },
  });

  const addPanel = (place, row, wheelsets, column, width) => {
    const cell = place.appendChild(make("div", "", { class: "panel" }));
    const [lines, marks] = [row.lines(wheelsets), row.marks?.(wheelsets, column) ?? []];
    const [bars, bands] = [row.bars?.(wheelsets) ?? [], row.bands?.(wheelsets) ?? []];
    const labels = cell.appendChild(make("div", "", { class: "labels" }));
    labels.style.cssText = `margin-left:${column ? RIGHT / 2 : LEFT}px`;
    const { start, end } = figure;
    const own = { row, column, wheelsets, lines, bands, marks, bars, labels, cell, data: joined([...edgesOf(bands), ...lines], start, end) };
    plots.push(own);
    own.plot = new uPlot(options(row, column, width, own), own.data, cell);
    hold(own.plot);
  };

  /* The axis has a place of its own at the foot, which stays in view while the panels are scrolled. */
  const addAxis = (place, column, width) => {
    const cell = place.appendChild(make("div", "", { class: "panel" }));
    const { start, end, across } = figure;
    const plot = new uPlot({
      width, height: AXIS + 2, padding: [0, RIGHT, 0, column ? RIGHT / 2 : 0], legend: { show: false },
      cursor: { show: false }, scales: { x: { time: false }, y: { range: () => [0, 1] } },
      axes: [
        axisOf({ size: AXIS - 14, label: column ? "" : across.title, labelSize: 14, labelFont: axisOf().font,
          values: (own, at, axis, space, step) => numbersOf(own, at.map(across.tick), axis, space, step) }),
        axisOf({ size: column ? 0 : LEFT, values: nothing, grid: { show: false } }),
      ],
      series: [{}, { show: false }],
    }, [[start, end], [null, null]], cell);
    plots.push({ plot, row: {}, column, wheelsets: [], lines: [], bands: [], marks: [], bars: [], data: [[start, end]], cell });
  };

  const paint = (wanted) => {
    for (const { plot } of plots) plot.destroy();
    plots = [];
    if (figure && (figure.start !== wanted.start || figure.end !== wanted.end)) range = null;
    figure = wanted;
    element.replaceChildren();
    const { rows, columns } = figure;
    const inner = (element.clientWidth - LEFT - RIGHT) / columns.length;
    const widthOf = (column) => Math.floor(column ? inner : inner + LEFT + RIGHT);
    if (columns.length > 1) {
      const heads = element.appendChild(make("div", "", { class: "panels-row heads" }));
      columns.forEach((wheelsets, c) => {
        const head = heads.appendChild(make("strong", `wheelset ${wheelsets[0]}`));
        head.style.cssText = `width:${widthOf(c)}px;padding-left:${c ? 4 : LEFT}px`;
      });
    }
    for (const row of rows) {
      const place = element.appendChild(make("div", "", { class: "panels-row" }));
      columns.forEach((wheelsets, c) => addPanel(place, row, wheelsets, c, widthOf(c)));
    }
    const foot = element.appendChild(make("div", "", { class: "panels-row foot" }));
    columns.forEach((_, c) => addAxis(foot, c, widthOf(c)));
    const [min, max] = inView();
    for (const { plot } of plots) plot.setScale("x", { min, max });
    element.plots = plots; /* What stands where, for whoever looks from outside. */
    queueMicrotask(() => {
      figure.ready = true;
      put();
    });
  };

  return {
    paint,
    show: (kind, from, to = from) => {
      spans.set(kind, from === null ? null : [from, to]);
      for (const each of plots) putSpan(each, kind);
    },
    ring: (place) => {
      circle = place;
      putRing();
    },
    panelOf: ({ plot, wheelset }) =>
      plots.find(({ row, wheelsets }) => row.key === plot && inColumn(wheelset, wheelsets))?.cell ?? element,
    zoom,
    inView,
    /* A part of the range in view: 0.5 is half of it; moved by a share of it. */
    scale: (factor, share = 0) => {
      const [low, high] = inView();
      const [middle, half] = [(low + high) / 2 + share * (high - low), ((high - low) / 2) * factor];
      zoom(middle - half, middle + half);
    },
    all: () => zoom(figure.start, figure.end),
  };
};

