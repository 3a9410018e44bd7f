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

/* The height of a line as it is drawn; to its end it stays at its last point. */
const valueAt = (curve, time) => {
  if (!curve) return NaN;
  const { x, y } = curve;
  const k = rowAt(x, time);
  if (k + 1 >= x.length || time <= x[k]) return y[k];
  return y[k] + ((time - x[k]) / (x[k + 1] - x[k])) * (y[k + 1] - y[k]);
};

const WHEELSET_ROWS = [
  ["wheel_speed", "speed, km/h", 1], ["slide", "slide, %", 1], ["tank_pressure", "tank, bar", 2],
  ["cylinder_pressure", "cylinder, bar", 2], ["clamping_force", "force, kN", 2], ["adhesion", "adhesion", 3],
  ["friction", "friction met", 3], ["cleaned_share", "cleaned share", 2],
  ["disc_surface_temperature", "disc surface, °C", 0], ["disc_temperature", "disc, °C", 0],
];
const TRAIN_ROWS = [
  ["speed", "train, km/h", 1], ["reference_speed", "reference, km/h", 1], ["distance", "distance, m", 1],
  ["deceleration", "deceleration, g", 3], ["brake_line_pressure", "brake line, bar", 2],
  ["reservoir_pressure", "reservoir, bar", 2],
];
