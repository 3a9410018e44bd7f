/* What the plots of a stop read at the cursor and, once one is pinned, between the two. */
const rowsRead = ["wheel_speed", "slide", "tank_pressure", "cylinder_pressure", "clamping_force", "dynamic_torque", "dynamic_reduction", "adhesion", "friction",
  "cleaned_share", "sand_density", "disc_surface_temperature", "disc_temperature"];
const trainRead = ["speed", "reference_speed", "distance", "deceleration", "track_brake_force", "brake_line_pressure", "reservoir_pressure"];
const quantityText = ({ label, unit }) => (unit === "1" ? label : `${label}, ${unit.replace("degC", "°C")}`);

/* The mean of the samples from one time to another. */
const meanBetween = ({ x, y }, from, to) => {
  const known = y.slice(rowAt(x, from), rowAt(x, to) + 1).filter((value) => value !== null);
  return known.reduce((sum, value) => sum + value, 0) / known.length;
};
const ventsBetween = (stop, n, from, to) => spansOf(stop, n, [2]).filter(([start]) => start >= from && start <= to).length;

const readout = (plots, stop) => {
  const body = first(".readout tbody", plots);
  const train = first(".train-readout", plots);
  const between = first(".between", plots);
  let [at, pin] = [stop.start, null];
  const cells = [];
  const { curves } = stop;
  const cell = (row, tag, content) => row.appendChild(make(tag, content));
  const ends = () => [Math.min(at, pin), Math.max(at, pin)];
  const reading = (curve, decimals) => () => {
    const how = pin === null ? "value" : chosen(plots, "reading");
    if (how === "value") return text(valueAt(curve, at), decimals);
    return text(how === "mean" ? meanBetween(curve, ...ends()) : valueAt(curve, at) - valueAt(curve, pin), decimals);
  };
  const addWheelsets = (label, read) => {
    const row = body.insertRow();
    cell(row, "th", label).scope = "row";
    for (const n of ROWS) cells.push([cell(row, "td", ""), read(n)]);
  };
  for (const key of rowsRead) {
    const own = common.quantities[key];
    if (`${key}_1` in curves) addWheelsets(quantityText(own), (n) => reading(curves[`${key}_${n}`], own.decimals));
  }
  if ("valve_command_1" in curves)
    addWheelsets("valve command", (n) => () => {
      if (pin !== null && chosen(plots, "reading") !== "value") return String(ventsBetween(stop, n, ...ends()));
      return stateText(curves[`valve_command_${n}`], at);
    });
  const valve = body.rows[body.rows.length - 1]?.cells[0];
  for (const key of trainRead)
    if (key in curves) {
      const own = common.quantities[key];
      const row = train.appendChild(make("div"));
      cell(row, "dt", quantityText(own));
      cells.push([cell(row, "dd", ""), reading(curves[key], own.decimals)]);
    }
  const read = () => {
    for (const [element, value] of cells) element.textContent = value();
    if (valve && "valve_command_1" in curves)
      valve.textContent = pin === null || chosen(plots, "reading") === "value" ? "valve command" : "vents";
    between.hidden = pin === null;
    if (pin !== null) first("output", between).textContent = `${text(at - pin, 2)} s from ${text(pin, 2)} s`;
  };
  first('[data-choice="reading"]', plots).addEventListener("change", read);
  return {
    show: (time) => {
      at = time;
      read();
    },
    pin: (time) => {
      pin = time;
      read();
    },
    pinned: () => pin,
  };
};
