/* Cases that are chosen in the table, laid over each other over the time since the brake command. */
const MOST_COMPARED = 8;
const CASE_DASHES = [[], [6, 2], [2, 2], [8, 2, 2, 2]];
const styleOf = (place) => ({ ink: `compared-${place + 1}`, dash: CASE_DASHES[place % CASE_DASHES.length] });

const comparedRow = (stops, axes, panel) => ({
  key: panel.key, title: titleOf(panel), height: 112 * panel.height, include: panel.include,
  lines: (wheelsets) =>
    stops.flatMap((stop, place) =>
      panel.lines
        .filter((each) => each.series in stop.curves && inColumn(wheelsetOf(each.role), wheelsets))
        .map((each) => ({ ...lineOf(stop, axes[place], each), ...styleOf(place), label: stop.id,
          width: each.role === "train" && panel.lines.length > 1 ? 2.4 : 1.4 }))),
});

/* The valves of each case in a row of its own: a thin bar while held, a full one while vented. */
const comparedValves = (stops, axes, lanes) => ({
  key: "valves", title: "WSP valves: vent magnet, pale where only held", height: 16 * stops.length + 10, include: [],
  ticks: new Map(stops.map((_, place) => [place + 1, String(place + 1)])), ruled: false, range: [0.5, stops.length + 0.5],
  lines: () => [],
  bars: ([n]) =>
    stops.flatMap((stop, place) => lanes.map((lane) => ({
      ...magnetBars(stop, axes[place], { ...lane, offset: 0 }, n, place + 1, styleOf(place).ink, 0.34),
      opacity: lane.label === "hold" ? 0.35 : 1,
    }))),
});

const comparedFigure = (stops, axes, width, wheelset) => {
  const panels = common.compared.filter((panel) => panel.lines.some((each) => stops.some((stop) => each.series in stop.curves)));
  const [speed, ...others] = panels.map((panel) => comparedRow(stops, axes, panel));
  const lanes = common.strips.find((strip) => strip.lanes.length).lanes;
  const rows = stops.some((stop) => "valve_command_1" in stop.curves) ? [speed, comparedValves(stops, axes, lanes), ...others] : [speed, ...others];
  const columns = wheelset === "apart" && width > 640 ? ROWS.map((n) => [n]) : [[Number(wheelset) || 1]];
  return { rows, columns, start: Math.min(...axes.map(({ start }) => start)), end: Math.max(...axes.map(({ end }) => end)), across: axes[0] };
};

/* Rows of the table: what the cursor reads of each case, then the measures that its own part of the page names. */
const comparedTable = (table, stops, wheelset) => {
  const head = first("thead", table);
  const body = first("tbody", table);
  const heads = stops.map((stop) => make("th", stop.id, { scope: "col", class: "number" }));
  const row = make("tr");
  row.append(make("th", wheelset === "apart" ? "wheelset 1" : `wheelset ${wheelset}`, { scope: "col" }), ...heads);
  head.replaceChildren(row);
  body.replaceChildren();
  const n = Number(wheelset) || 1;
  const reads = [];
  const add = (label, cells) => {
    const own = body.insertRow();
    own.append(make("th", label, { scope: "row" }), ...cells);
  };
  const read = (key, name) => [name, quantityText(common.quantities[key]), common.quantities[key].decimals];
  const followed = [
    ...["speed", "distance", "deceleration"].map((key) => read(key, key)), ...rowsRead.map((key) => read(key, `${key}_${n}`)),
  ].filter(([name]) => stops.some((stop) => name in stop.curves));
  for (const [name, label, decimals] of followed) {
    const cells = stops.map(() => make("td", "", { class: "number" }));
    add(label, cells);
    stops.forEach((stop, k) => reads.push((time) => {
      cells[k].textContent = time > stop.end ? "–" : text(valueAt(stop.curves[name], time), decimals);
    }));
  }
  const figures = stops.map((stop) => new Map(all(".figures > div", stop.place).map((each) =>
    [first("dt", each).textContent, first("dd", each).textContent])));
  for (const label of new Set(figures.flatMap((each) => [...each.keys()])))
    add(label, figures.map((each) => make("td", each.get(label) ?? "–", { class: "number" })));
  return (time) => reads.forEach((read) => read(time));
};

const caseKey = (stop, place) => {
  const entry = make("li");
  const { ink, dash } = styleOf(place);
  const swatch = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  swatch.setAttribute("viewBox", "0 0 24 8");
  swatch.setAttribute("class", "swatch");
  swatch.setAttribute("aria-hidden", "true");
  const stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
  stroke.setAttribute("d", "M1 4H23");
  stroke.setAttribute("class", "line");
  stroke.style.cssText = `stroke:var(--${ink});stroke-width:2;stroke-dasharray:${dash.length ? dash : "none"}`;
  swatch.append(stroke);
  entry.append(swatch, `${place + 1} `, make("a", stop.id, { href: `#${stop.fragment}` }), stop.recorded ? " (recorded)" : "");
  return entry;
};

const offerComparison = (section, boxes, bar) => {
  const panels = first(".compared-plot", section);
  const slider = first("input", section);
  const known = new Map();
  let [stops, axes, move, at, choices] = [[], [], () => {}, 0, 0];
  const view = viewer(panels, { moved: (x) => show(axes[0].time(x)), pinned: () => {} });

  const stopAt = async (fragment) => {
    if (!known.has(fragment)) {
      const place = target(`#${fragment}`);
      known.set(fragment, { ...(await stopOf(first("script.trace", place))), fragment, place });
    }
    return known.get(fragment);
  };
  const end = () => Math.max(...stops.map((stop) => stop.end));
  const show = (time) => {
    at = Math.max(0, Math.min(time, end()));
    slider.value = (slider.max * at) / (end() || 1);
    slider.setAttribute("aria-valuetext", `${text(at, 2)} seconds`);
    first("output", section).textContent = `${text(at, 2)} s`;
    view.show("cursor-line", axes[0].at(at));
    move(at);
  };
  const paint = () => {
    if (stops.length < 2) return;
    const wheelset = chosen(section, "wheelset");
    axes = stops.map((stop) => axisOver(stop, "time"));
    view.paint(comparedFigure(stops, axes, panels.clientWidth, wheelset));
    first(".cases", section).replaceChildren(...stops.map(caseKey));
    move = comparedTable(first("table", section), stops, wheelset);
    show(at);
  };
  const choose = async () => {
    const wanted = boxes.filter((box) => box.checked);
    const own = (choices += 1);
    for (const box of boxes) box.disabled = !box.checked && wanted.length >= MOST_COMPARED;
    bar.hidden = !wanted.length;
    section.hidden = wanted.length < 2;
    bar.replaceChildren(wanted.length < 2 ? "1 case chosen: choose another to compare."
      : make("a", `Compare ${wanted.length} cases`, { href: "#compared" }));
    const read = await Promise.all(wanted.map((box) => stopAt(box.value)));
    if (own !== choices) return; /* Another choice was made while the stops were read. */
    stops = read;
    paint();
  };
  for (const box of boxes) box.addEventListener("change", choose);
  slider.addEventListener("input", () => show((slider.value / slider.max) * end()));
  first("select", section).addEventListener("change", paint);
  first("button.clear", section).addEventListener("click", () => {
    for (const box of boxes) box.checked = false;
    choose();
    boxes[0].focus();
  });
  offerZoom(first(".zoom", section), view);
  redraw.push(paint);
};

if (canPlot && first("#compared"))
  offerComparison(first("#compared"), all("input.compare"), first(".comparison-bar"));
else for (const box of all("input.compare")) box.hidden = true;
