/* One quantity over another, of one wheelset, while the plots over time show that part of the stop. */
const loopsIn = (stop) =>
  common.loops.filter((loop) => loop.lines.some(({ series, over }) => series in stop.curves && over in stop.curves));

const REVERSAL = 0.02; /* of the range: what is no reversal but noise */

/* Whether x rises (1) or falls (-1) at each sample; it turns once it has come back by some share of its range. */
const directions = (x) => {
  const [low, high] = extentOf(x);
  const least = REVERSAL * (high - low);
  const result = new Int8Array(x.length);
  let [direction, extreme, turned] = [1, x[0], 0];
  x.forEach((value, k) => {
    if (value === null) return;
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

/* Lines through the points, or the points themselves; where x falls a directed line is dashed and paler. */
const paintLoop = (plot, { dots, directed }, { x, y, way }, ink, rows) =>
  clipped(plot, (ctx, bbox, across, up, pixel) => {
    ctx.globalAlpha = 0.75;
    if (dots) {
      ctx.fillStyle = colour(ink);
      for (let k = rows[0]; k <= rows[1]; k += 1)
        if (y[k] !== null && x[k] !== null) ctx.fillRect(across(x[k]) - pixel, up(y[k]) - pixel, 2.4 * pixel, 2.4 * pixel);
      return;
    }
    ctx.lineWidth = 1.4 * pixel;
    for (const direction of directed ? [1, -1] : [0]) {
      ctx.strokeStyle = colour(direction < 0 ? "falling" : ink);
      ctx.setLineDash(direction < 0 ? [4 * pixel, 2 * pixel] : []);
      ctx.beginPath();
      for (let k = rows[0] + 1; k <= rows[1]; k += 1) {
        if (direction && way[k] !== direction) continue;
        if ([x[k], y[k], x[k - 1], y[k - 1]].includes(null)) continue;
        if (k === rows[0] + 1 || (direction && way[k - 1] !== direction) || y[k - 2] === null) ctx.moveTo(across(x[k - 1]), up(y[k - 1]));
        ctx.lineTo(across(x[k]), up(y[k]));
      }
      ctx.stroke();
    }
  });

/* The plots of all loops of a stop, for the wheelset and the part of the stop that are chosen. */
const loopPlots = (place, stop) => {
  let plots = [];
  let [rows, at] = [[0, Infinity], stop.start];
  const put = () => {
    for (const { plot, curve, dot } of plots) {
      const [x, y] = [{ x: curve.time, y: curve.x }, { x: curve.time, y: curve.y }].map((each) => valueAt(each, at));
      const [left, top] = [plot.valToPos(x, "x"), plot.valToPos(y, "y")];
      dot.hidden = !(left >= 0 && left <= plot.over.clientWidth && top >= 0 && top <= plot.over.clientHeight);
      dot.style.cssText = `left:${left}px;top:${top}px`;
    }
  };
  const addLoop = (cell, loop, line, wheelset) => {
    const [across, up] = [stop.curves[line.over], stop.curves[line.series]];
    const curve = { time: across.x, x: across.y, y: up.y, way: loop.directed && directions(across.y) };
    cell.append(make("div", `${loop.title}, wheelset ${wheelset}`, { class: "plot-title" }));
    const [x, y] = [spanOf([...loop.include, ...extentOf(curve.x)]), spanOf([0, ...extentOf(curve.y)])];
    const titled = (label, size) => axisOf({ label, size, labelSize: 16, labelFont: axisOf().font, values: numbersOf });
    const plot = new uPlot({
      width: Math.floor(cell.clientWidth), height: 290, padding: [4, RIGHT, 0, 0], legend: { show: false },
      cursor: { x: false, y: false, points: { show: false }, drag: { x: true, y: true, dist: 5 } },
      scales: { x: { time: false, range: () => x }, y: { range: () => y } },
      axes: [titled(loop.across_title, 24), titled(loop.up_title, LEFT)],
      series: [{}, { show: false }],
      hooks: { draw: [(own) => paintLoop(own, loop, curve, line.role, [Math.max(rows[0], 0), Math.min(rows[1], curve.x.length - 1)])], setScale: [() => queueMicrotask(put)] },
    }, [x, [null, null]], cell);
    plots.push({ plot, curve, loop, dot: plot.over.appendChild(make("div", "", { class: "cursor-dot" })) });
  };
  return {
    paint: (wheelset) => {
      for (const { plot } of plots) plot.destroy();
      plots = [];
      place.replaceChildren();
      const lines = loopsIn(stop).map((loop) => [
        loop, loop.lines.find((each) => inColumn(wheelsetOf(each.role), [wheelset]) && each.series in stop.curves)]);
      const cells = lines.filter(([, line]) => line).map((each) => [place.appendChild(make("div", "", { class: "loop" })), ...each]);
      for (const each of cells) addLoop(...each, wheelset);
      place.plots = plots;
      put();
    },
    within: (from, to) => {
      const grid = plots[0]?.curve.time ?? [];
      rows = [rowAt(grid, from), rowAt(grid, to) + 1];
      for (const { plot } of plots) plot.redraw(false);
    },
    show: (time) => {
      at = time;
      put();
    },
  };
};
