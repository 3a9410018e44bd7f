/* Drawn cases as points: a panel for each chosen parameter and measure, one cursor for all of them. */
const PANEL = { width: 300, height: 216, left: 50, right: 292, top: 24, bottom: 172 };
const SHAPES = {
  good: ["m-2 0a2 2 0 1 0 4 0a2 2 0 1 0-4 0", "m-2-2h4v4h-4z"],
  bad: ["m-3-3l6 6m0-6l-6 6", "m-3.5 0h7m-3.5-3.5v7", "m0-3.5l3.5 6h-7z"],
  odd: ["m0-3.5l3.5 3.5l-3.5 3.5l-3.5-3.5z", "m-3 3h6l-3-6z"],
};

const titleOf = ({ name, unit, logarithmic }) => `${name}${unit ? `, ${unit}` : ""}${logarithmic ? ", logarithmic" : ""}`;

/* A title that is as short as its panel: the last parts of a dotted key say most. */
const LONGEST_TITLE = 40;
const fittedTitle = (column) => {
  let title = titleOf(column);
  const parts = column.name.split(".");
  while (title.length > LONGEST_TITLE && parts.length > 1) {
    parts.shift();
    title = titleOf({ ...column, name: `…${parts.join(".")}` });
  }
  return title;
};
const roundStep = (step) => {
  const power = 10 ** Math.floor(Math.log10(step));
  return [1, 2, 5, 10].map((factor) => factor * power).find((each) => each >= step * (1 - 1e-9));
};
/* A number in words: whole ones, as seeds, with all their digits. */
const numberLabel = (value) => String(Number.isInteger(value) ? value : Number(value.toPrecision(6)));

/* One, two and five times each power of ten; of many powers the ones alone. */
const roundOfDecades = (first, last) => {
  const decades = Array.from({ length: last - first + 1 }, (_, k) => first + k);
  const factors = decades.length > 4 ? [1] : [1, 2, 5];
  return decades.flatMap((power) => factors.map((factor) => Number(`${factor}e${power}`)));
};

/* An axis from the smallest to the largest value, with a little air. */
const numberAxis = ({ values, logarithmic }, start, end) => {
  const known = values.filter((value) => value !== null);
  const scaled = (value) => (logarithmic ? Math.log10(value) : value);
  let [low, high] = [Math.min(...known), Math.max(...known)].map(scaled);
  if (!(high > low)) [low, high] = [(low || 0) - 0.5, (low || 0) + 0.5];
  const air = 0.04 * (high - low);
  const at = (value) => start + ((scaled(value) - low + air) / (high - low + 2 * air)) * (end - start);
  let ticks = (logarithmic ? roundOfDecades(Math.floor(low), Math.ceil(high)) : [])
    .filter((tick) => scaled(tick) >= low - air && scaled(tick) <= high + air);
  if (ticks.length < 3) {
    const [from, to] = logarithmic ? [10 ** low, 10 ** high] : [low, high];
    const step = roundStep((to - from) / 4);
    ticks = Array.from({ length: 8 }, (_, k) => (Math.ceil(from / step - 1e-9) + k) * step).filter((tick) => tick <= to * (1 + 1e-9));
  }
  return { at, ticks: ticks.map((tick) => [at(tick), String(Number(tick.toPrecision(12)))]) };
};

const textAt = (content, x, y, kind) => {
  const element = drawnElement("text", { x, y, class: kind });
  element.textContent = content;
  return element;
};

const scatterPanel = (data, across, up) => {
  const { width, height, left, right, top, bottom } = PANEL;
  const label = `${titleOf(up)} over ${titleOf(across)}`;
  const svg = drawnElement("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  const [x, y] = [numberAxis(across, left, right), numberAxis(up, bottom, top)];
  let [labelled, room] = [-Infinity, 0];
  for (const [at, text] of x.ticks) {
    const wide = 3.2 * text.length; /* half of what the label takes */
    if (at - labelled < wide + room + 4) continue;
    [labelled, room] = [at, wide];
    svg.append(drawnElement("path", { class: "grid", d: `M${at.toFixed(1)} ${top}V${bottom}` }), textAt(text, at, bottom + 15, "tick middle"));
  }
  for (const [at, text] of y.ticks)
    svg.append(drawnElement("path", { class: "grid", d: `M${left} ${at.toFixed(1)}H${right}` }), textAt(text, left - 6, at + 4, "tick end"));
  svg.append(drawnElement("rect", { class: "frame", x: left, y: top, width: right - left, height: bottom - top }));
  svg.append(textAt(fittedTitle(up), 4, 13, "plot-title"), textAt(fittedTitle(across), width / 2, height - 8, "plot-title middle"));
  const places = data.ids.map((_, k) => (across.values[k] === null || up.values[k] === null ? null : [x.at(across.values[k]), y.at(up.values[k])]));
  data.words.forEach(({ tone, shape }, number) => {
    const own = places.filter((place, k) => place && data.word[k] === number);
    const d = own.map(([px, py]) => `M${px.toFixed(1)} ${py.toFixed(1)}${shape}`).join("");
    svg.append(drawnElement("path", { class: `points tone-${tone}${own.length > 300 ? " faint" : ""}`, d }));
  });
  for (const k of Object.keys(data.stops))
    if (places[k]) svg.append(drawnElement("circle", { class: "of-stop", cx: places[k][0], cy: places[k][1], r: 6 }));
  const ring = svg.appendChild(drawnElement("circle", { class: "point-ring", r: 6, visibility: "hidden" }));
  const mark = (k) => {
    ring.setAttribute("visibility", places[k] ? "visible" : "hidden");
    if (places[k]) ["cx", "cy"].forEach((name, c) => ring.setAttribute(name, places[k][c]));
  };
  const nearest = (event) => {
    const box = svg.getBoundingClientRect();
    const scale = width / box.width;
    const [px, py] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    let [found, least] = [-1, 15 ** 2];
    places.forEach((place, k) => {
      if (!place) return;
      const distance = (place[0] - px) ** 2 + (place[1] - py) ** 2;
      if (distance < least) [found, least] = [k, distance];
    });
    return found;
  };
  return { svg, mark, nearest, without: places.filter((place) => !place).length };
};

/* Each word has a shape of its own among those of its tone. */
const withShapes = (words) => {
  const used = { good: 0, bad: 0, odd: 0 };
  return words.map((each) => ({ ...each, shape: SHAPES[each.tone][Math.min(used[each.tone]++, SHAPES[each.tone].length - 1)] }));
};

const scatterKey = (data) =>
  data.words.flatMap(({ word, tone, shape, all: count }, number) => {
    const entry = make("span", "", { class: "outcome-key" });
    const swatch = drawnElement("svg", { viewBox: "0 0 12 12", width: 12, height: 12, "aria-hidden": "true" });
    swatch.append(drawnElement("path", { class: `points tone-${tone}`, d: `M6 6${shape}` }));
    const shown = data.word.filter((each) => each === number).length;
    entry.append(swatch, ` ${word}: ${shown === count ? count : `${shown} of ${count} shown`}`);
    return [entry, " "];
  });

const csvOfPoints = (data) => {
  const columns = [...data.parameters, ...data.measures];
  const head = ["case", "verdict", ...columns.map(({ name, unit }) => (unit ? `${name}, ${unit}` : name))];
  const lines = data.ids.map((id, k) => [id, data.words[data.word[k]].word, ...columns.map(({ values }) => (values[k] === null ? "" : String(values[k])))]);
  return csvLines([head, ...lines]);
};

const offerScatter = (section) => {
  const data = json(first("#scatter-data", section));
  data.words = withShapes(data.words);
  const place = first(".panels-of-points", section);
  const slider = first("input[type=range]", section);
  const output = first(".scatter-readout output", section);
  let panels = [];
  const boxes = (kind) => all(`input[name="scatter-${kind}"]`, section);
  const chosenOf = (kind, columns) => boxes(kind).filter((box) => box.checked).map((box) => columns[Number(box.value)]);

  const show = (k) => {
    slider.value = k;
    slider.setAttribute("aria-valuetext", data.ids[k]);
    for (const panel of panels) panel.mark(k);
    const numbers = [...data.parameters, ...data.measures].map(({ name, unit, values }) =>
      `${name} ${values[k] === null ? "–" : numberLabel(values[k])}${unit ? ` ${unit}` : ""}`);
    const name = k in data.stops ? make("a", data.ids[k], { href: `#${data.stops[k]}` }) : data.ids[k];
    output.replaceChildren(name, `: ${data.words[data.word[k]].word}; ${numbers.join("; ")}`);
  };
  const paint = () => {
    const [across, up] = [chosenOf("parameter", data.parameters), chosenOf("measure", data.measures)];
    for (const [kind, chosen] of [["parameter", across], ["measure", up]])
      for (const box of boxes(kind)) box.disabled = !box.checked && chosen.length >= data.limits[kind];
    panels = up.flatMap((measure) => across.map((parameter) => scatterPanel(data, parameter, measure)));
    place.replaceChildren(...panels.map(({ svg }) => svg));
    place.style.setProperty("--across", Math.max(across.length, 2));
    place.classList.toggle("matrix", across.length > 1);
    const without = up.map((measure) => [measure.name, measure.values.filter((value) => value === null).length]).filter(([, count]) => count);
    first(".scatter-shown", section).textContent = [
      `Panels: ${across.length} of ${data.parameters.length} parameters across, ${up.length} of ${data.measures.length} measures up; at most ${data.limits.parameter} and ${data.limits.measure}.`,
      ...without.map(([name, count]) => `${count} points have no ${name}.`),
      Object.keys(data.stops).length ? "A ringed point leads to its stop." : "",
    ].filter(Boolean).join(" ");
    for (const panel of panels) {
      const hover = (event) => {
        const k = panel.nearest(event);
        if (k >= 0) show(k);
        return k;
      };
      panel.svg.addEventListener("pointermove", hover);
      panel.svg.addEventListener("click", (event) => {
        const k = hover(event);
        if (k in data.stops) location.hash = data.stops[k];
      });
    }
    show(Number(slider.value));
  };
  slider.max = data.ids.length - 1;
  slider.addEventListener("input", () => show(Number(slider.value)));
  for (const box of [...boxes("parameter"), ...boxes("measure")]) box.addEventListener("change", paint);
  first("button.csv", section).addEventListener("click", () => save("points.csv", csvOfPoints(data)));
  first(".scatter-key", section).replaceChildren(...scatterKey(data));
  paint();
};
if (first("#scatter-data")) offerScatter(first("section.scatter"));
