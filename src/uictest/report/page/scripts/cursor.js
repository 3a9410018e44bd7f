/* One cursor for all plots of a stop: moved by the pointer or, with the keyboard, by the slider. */

/* An upright line over every column of panels, from `from` to `to`. */
const uprights = (panels, kind) => {
  const lines = [];
  let span = null;
  const put = () => {
    const { _size: size, ...layout } = panels._fullLayout;
    const axes = span ? Object.keys(layout).filter((name) => /^xaxis\d*$/.test(name)).map((name) => layout[name]) : [];
    while (lines.length < axes.length) lines.push(panels.appendChild(make("div", "", { class: kind })));
    lines.forEach((element, k) => {
      const each = axes[k];
      element.hidden = !each;
      if (!each) return;
      const [from, to] = span.map((time) => Math.min(Math.max(each.l2p(time), 0), each._length));
      const outside = each.l2p(span[1]) < 0 || each.l2p(span[0]) > each._length;
      element.hidden = outside;
      element.style.cssText = `left:${each._offset + from}px;top:${size.t}px;height:${size.h}px;width:${Math.max(to - from, 1)}px`;
    });
  };
  panels.on("plotly_afterplot", put);
  return (from, to) => {
    span = from === null ? null : [from, to];
    put();
  };
};

/* A dot in every loop, at the values of the wheelset that is shown. */
const loopDots = (loops, stop, wheelset) => {
  const dots = loopsIn(stop).map((loop) => [loop, loops.appendChild(make("div", "", { class: "cursor-dot" }))]);
  let at = stop.start;
  const curveOf = (name) => stop.curves[`${name}_${wheelset()}`] ?? stop.curves[name];
  const put = () =>
    dots.forEach(([loop, dot], k) => {
      const { [`xaxis${k ? k + 1 : ""}`]: x, [`yaxis${k ? k + 1 : ""}`]: y } = loops._fullLayout;
      const [across, up] = [loop.across, loop.up].map((name) => valueAt(curveOf(name), at));
      const [left, top] = [x.l2p(across), y.l2p(up)];
      dot.hidden = !(left >= 0 && left <= x._length && top >= 0 && top <= y._length);
      dot.style.cssText = `left:${x._offset + left}px;top:${y._offset + top}px`;
    });
  loops.on("plotly_afterplot", put);
  return (time) => {
    at = time;
    put();
  };
};

const cursor = (plots, stop, panels, followers) => {
  const slider = first(".readout input", plots);
  const output = first(".readout output", plots);
  const body = first(".readout tbody", plots);
  const train = first(".train-readout", plots);
  const mark = uprights(panels, "cursor-line");

  const cell = (row, tag, content) => row.appendChild(make(tag, content));
  const cells = [];
  const build = (label, read) => {
    const row = body.insertRow();
    cell(row, "th", label).scope = "row";
    for (const n of ROWS) cells.push([cell(row, "td", ""), (time) => read(n, time)]);
  };
  const { curves } = stop;
  for (const [name, label, decimals] of WHEELSET_ROWS)
    if (`${name}_1` in curves) build(label, (n, time) => text(valueAt(curves[`${name}_${n}`], time), decimals));
  if ("valve_command_1" in curves) build("valve", (n, time) => stateText(curves[`valve_command_${n}`], time));
  for (const [name, label, decimals] of TRAIN_ROWS)
    if (name in curves) {
      const row = train.appendChild(make("div"));
      cell(row, "dt", label);
      cells.push([cell(row, "dd", ""), (time) => text(valueAt(curves[name], time), decimals)]);
    }

  const show = (time) => {
    const at = Math.max(stop.start, Math.min(time, stop.end));
    slider.value = (slider.max * (at - stop.start)) / (stop.end - stop.start || 1);
    slider.setAttribute("aria-valuetext", `${text(at, 2)} seconds`);
    output.textContent = `${text(at, 2)} s`;
    for (const [element, read] of cells) element.textContent = read(at);
    mark(at, at);
    for (const follow of followers) follow(at);
  };
  slider.addEventListener("input", () =>
    show(stop.start + (slider.value / slider.max) * (stop.end - stop.start)));
  panels.on("plotly_hover", ({ xvals }) => show(xvals[0]));
  const worthwhile = (each) => each.status !== "pass" || each.kind === "window";
  const start = stop.marks.find((each) => each.plot !== "over-distance" && each.x0 !== null && worthwhile(each));
  show(start ? start.x0 : stop.start);
  return show;
};
