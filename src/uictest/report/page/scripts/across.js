/* What a stop is drawn over: time, distance, or the speed of the train, which falls to the right. */
const OVER = {
  time: { title: "time since the brake command, s", unit: "s", decimals: 2 },
  distance: { title: "distance since the brake command, m", unit: "m", decimals: 1, series: "distance", sign: 1 },
  speed: { title: "speed of the train, km/h", unit: "km/h", decimals: 1, series: "speed", sign: -1 },
};

/* Values that only rise: where noise lets them fall, the last one stays. */
const monotone = (y, sign) => {
  let last = sign * y.find((value) => value !== null);
  return Float64Array.from(y, (value) => (last = value === null || sign * value < last ? last : sign * value));
};

/* Between the time of a stop and its place on the axis, both ways; `of` gives the x of a line. */
const axisOver = (stop, name) => {
  const { series, sign = 1, ...words } = OVER[name];
  const curve = stop.curves[series];
  if (!curve?.y.some((value) => value !== null))
    return { ...words, name: "time", ...OVER.time, start: stop.start, end: stop.end, at: (time) => time, time: (x) => x, of: ({ x }) => x, tick: (x) => x };
  const grid = curve.x;
  const along = monotone(curve.y, sign);
  const at = (time) => valueAt({ x: grid, y: along }, time);
  return {
    ...words, name, at, start: along[0], end: along.at(-1), tick: (x) => sign * x,
    time: (x) => {
      const row = rowAt(along, x);
      const [low, high] = [along[row], along[row + 1] ?? along[row]];
      return grid[row] + (high > low ? (Math.min(Math.max(x - low, 0), high - low) / (high - low)) * (grid[row + 1] - grid[row]) : 0);
    },
    of: (line) => (line.x === grid ? along : Float64Array.from(line.x, at)),
  };
};

/* Marks of a stop on its axis: they lie at times or, of a distance, where the stop has covered it. */
const marksOn = (stop, axis) => {
  const covered = axisOver(stop, "distance");
  const place = (mark, x) => (x === null ? null : axis.at(mark.along === "distance" ? covered.time(x) : x));
  return stop.marks
    .filter((mark) => mark.along !== "distance" || covered.name === "distance")
    .map((mark) => ({ ...mark, x0: place(mark, mark.x0), x1: place(mark, mark.x1) }));
};
