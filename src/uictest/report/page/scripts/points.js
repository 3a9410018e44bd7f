/* Drawn cases: one cursor for all panels of points. */
const offerPoints = (section) => {
  const data = json(first("#points-data", section));
  const slider = first("input[type=range]", section);
  const output = first("output", section);
  const pixel = ({ axis: { low, high, start, end, logarithmic }, values }, k) => {
    if (values[k] === null) return NaN;
    const share = logarithmic ? Math.log(values[k] / low) / Math.log(high / low) : (values[k] - low) / (high - low);
    return start + share * (end - start);
  };
  const panels = all("svg[data-across]", section).map((svg) => {
    const [x, y] = [data.parameters[svg.dataset.across], data.measures[svg.dataset.up]];
    const places = data.ids.map((_, k) => [pixel(x, k), pixel(y, k)]);
    const ring = svg.appendChild(document.createElementNS("http://www.w3.org/2000/svg", "circle"));
    ring.setAttribute("class", "point-ring");
    ring.setAttribute("r", 6);
    return { svg, places, ring };
  });
  const show = (k) => {
    slider.value = k;
    slider.setAttribute("aria-valuetext", data.ids[k]);
    for (const { places: { [k]: [x, y] }, ring } of panels) {
      ring.setAttribute("visibility", x + y === x + y ? "visible" : "hidden");
      if (x + y === x + y) [["cx", x], ["cy", y]].forEach(([name, at]) => ring.setAttribute(name, at));
    }
    const numbers = [...data.parameters, ...data.measures].map(({ name, unit, values }) => {
      const own = Number.isInteger(values[k]) ? values[k] : Number(values[k]?.toPrecision(6));
      return `${name} ${values[k] === null ? "–" : own}${unit ? ` ${unit}` : ""}`;
    });
    const name = k in data.stops ? make("a", data.ids[k], { href: `#${data.stops[k]}` }) : data.ids[k];
    output.replaceChildren(name, `: ${data.words[k]}; ${numbers.join("; ")}`);
  };
  for (const { svg, places } of panels)
    svg.addEventListener("pointermove", (event) => {
      const box = svg.getBoundingClientRect();
      const scale = svg.viewBox.baseVal.width / box.width;
      const [px, py] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
      let [nearest, least] = [-1, 15 ** 2];
      places.forEach(([x, y], k) => {
        const distance = (x - px) ** 2 + (y - py) ** 2;
        if (distance < least) [nearest, least] = [k, distance];
      });
      if (nearest >= 0) show(nearest);
    });
  slider.max = data.ids.length - 1;
  slider.addEventListener("input", () => show(Number(slider.value)));
  show(0);
};
all(".points-of-cases").forEach(offerPoints);
