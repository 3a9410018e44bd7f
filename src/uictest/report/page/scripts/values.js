/* Values of a stop at a time, as texts. */
const text = (value, decimals) =>
  Number.isFinite(value) ? value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1") : "–";

/* The row of the last x that is not behind a time. */
const rowAt = (x, time) => {
  let low = 0;
  let high = x.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
};

const stateAt = (curve, time) => (curve ? curve.y[rowAt(curve.x, time)] : NaN);
const stateText = (curve, time) => STATES[Math.round(stateAt(curve, time))] ?? "–";

/* The height of a line as it is drawn, NaN in a gap; beyond its end it stays at its last point. */
const valueAt = (curve, time) => {
  if (!curve) return NaN;
  const { x, y } = curve;
  const k = rowAt(x, time);
  const [from, to] = [y[k] ?? NaN, y[k + 1] ?? NaN];
  if (k + 1 >= x.length || time <= x[k]) return from;
  return from + ((time - x[k]) / (x[k + 1] - x[k])) * (to - from);
};
