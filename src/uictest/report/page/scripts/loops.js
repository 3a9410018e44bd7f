/* One quantity over another. A loop of wheelsets shows one of them, and which way it is run through. */
const loopsIn = (stop) =>
  common.loops.filter((loop) => loop.lines.some((each) => `${loop.key} ${each.series}` in stop.loops));

const REVERSAL = 0.02; /* of the range: what is no reversal but noise */
const ARROWS = 10;

/* Whether x rises (1) or falls (-1) at each sample; it turns once it has come back by some share of its range. */
const directions = (x) => {
  let [low, high] = [Infinity, -Infinity];
  for (const value of x) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const least = REVERSAL * (high - low);
  const result = new Int8Array(x.length);
  let [direction, extreme, turned] = [1, x[0], 0];
  x.forEach((value, k) => {
    if (direction * (value - extreme) >= 0) [extreme, turned] = [value, k];
    else if (direction * (extreme - value) > least) {
      direction = -direction;
      result.fill(direction, turned + 1, k);
      [extreme, turned] = [value, k];
    }
    result[k] = direction;
  });
  return result;
};

/* The part of a curve that is run through in one direction; gaps between its pieces. */
const partOf = ({ x, y }, way, direction) => {
  const part = { x: [], y: [] };
  for (let k = 1; k < x.length; k += 1) {
    if (way[k] !== direction) continue;
    if (way[k - 1] !== direction || k === 1) {
      part.x.push(null, x[k - 1]);
      part.y.push(null, y[k - 1]);
    }
    part.x.push(x[k]);
    part.y.push(y[k]);
  }
  return part;
};

/* Arrowheads half-way through the longest pieces: a hidden point and a head that points away from it. */
const arrowsOf = ({ x, y }, way, direction, style) => {
  const pieces = [];
  for (let k = 1, from = 0; k <= x.length; k += 1)
    if (k === x.length || way[k] !== way[from + 1]) {
      if (way[from + 1] === direction) pieces.push([Math.abs(x[k - 1] - x[from]), from, k - 1]);
      from = k - 1;
    }
  const longest = pieces.sort(([a], [b]) => b - a).slice(0, ARROWS);
  const heads = longest.map(([, from, to]) => {
    const middle = (x[from] + x[to]) / 2;
    for (let k = from + 1; k <= to; k += 1) if (direction * (x[k] - middle) >= 0) return k;
    return to;
  });
  return {
    type: "scatter", mode: "markers", hoverinfo: "none", ...style,
    x: heads.flatMap((k) => [x[k - 1], x[k]]), y: heads.flatMap((k) => [y[k - 1], y[k]]),
    marker: { symbol: "arrow", angleref: "previous", size: heads.flatMap(() => [0, 10]), color: style.line.color },
  };
};

const directedTraces = (curve, each, place) => {
  const way = directions(curve.x);
  return [[1, colour(each.role), "solid"], [-1, colour("falling"), "4px,2px"]].flatMap(([direction, ink, dash]) => {
    const style = { meta: each.role, name: direction > 0 ? "rising" : "falling", line: { color: ink, width: 1.4, dash }, ...place };
    return [
      { type: "scatter", mode: "lines", hoverinfo: "none", opacity: 0.7, connectgaps: false, ...partOf(curve, way, direction), ...style },
      arrowsOf(curve, way, direction, style),
    ];
  });
};

const loopTraces = (loop, each, curve, place) => {
  if (loop.directed) return directedTraces(curve, each, place);
  const drawn = loop.dots ? { mode: "markers", marker: { color: colour(each.role), size: 3 } } : {};
  return [line(each, { ...curve, opacity: 0.8, ...drawn, ...place }, true)];
};

const loopsFigure = (stop, width, wheelset) => {
  const drawn = loopsIn(stop);
  const count = drawn.length;
  const stacked = width < 640;
  const grid = { pattern: "independent", xgap: 0.16, ygap: 0.24, rows: stacked ? count : 1, columns: stacked ? 1 : count };
  const traces = [];
  const layout = { shapes: [], annotations: [], grid };
  const pixels = (width - 60) / (stacked ? 1 : count * 1.16);
  drawn.forEach((loop, k) => {
    const tail = k ? k + 1 : "";
    const [x, y] = [`x${tail}`, `y${tail}`];
    const lines = loop.lines.filter((each) => inColumn(wheelsetOf(each.role), [wheelset]));
    for (const each of lines) {
      const curve = stop.loops[`${loop.key} ${each.series}`];
      if (curve) traces.push(...loopTraces(loop, each, curve, { xaxis: x, yaxis: y }));
    }
    const own = lines.some((each) => wheelsetOf(each.role)) ? `, wheelset ${wheelset}` : "";
    const titled = (text) => ({ text, font: { size: 11 }, standoff: 4 });
    layout[`xaxis${tail}`] = axis({ nticks: 6, autorangeoptions: { include: loop.include }, title: titled(loop.across_title) });
    layout[`yaxis${tail}`] = axis({ nticks: 6, title: titled(loop.up_title), automargin: true });
    const marks = stop.marks.filter((mark) => mark.plot === loop.key);
    for (const mark of marks)
      if (mark.kind === "point") traces.push(pointOf(mark, x, y));
      else layout.shapes.push(shapeOf(mark, x, y));
    layout.annotations.push(...labelsAbove(labelRows(loop.title + own, marks, pixels, () => pixels), pixels, x, y));
  });
  return { traces, layout: frame({ ...layout, height: stacked ? 280 * count : 320, hovermode: false, margin: { l: 52, r: 8, t: 44, b: 44 } }) };
};
