"use strict";
(() => {
  const root = document.documentElement;
  root.classList.add("js");
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const first = (selector, within = document) => within.querySelector(selector);
  const json = (element) => JSON.parse(element.textContent);

  /* Appearance ------------------------------------------------------------------------------------------------ */

  const redraw = [];
  const repaint = () => redraw.forEach((paint) => paint());
  all('input[name="theme"]').forEach((choice) =>
    choice.addEventListener("change", () => {
      if (choice.value === "auto") delete root.dataset.theme;
      else root.dataset.theme = choice.value;
      repaint();
    }),
  );
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);

  /* A colour of the style sheet as the browser computes it: what the plots can take. */
  const probe = document.createElement("i");
  probe.hidden = true;
  document.body.append(probe);
  const colour = (name) => {
    probe.style.color = `var(--${name})`;
    return getComputedStyle(probe).color;
  };

  /* Verdict table --------------------------------------------------------------------------------------------- */

  const table = first("table.verdicts");
  const filters = first("form.filters");
  if (table && filters) {
    const rows = all("tbody tr", table);
    const contents = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));

    const filter = () => {
      const words = new Set(all('input[name="word"]:checked', filters).map((box) => box.value));
      const sought = filters.elements.text.value.toLowerCase().split(/\s+/);
      const { outcome, scenario } = filters.elements;
      let shown = 0;
      for (const row of rows) {
        const wanted =
          words.has(row.dataset.word) &&
          (!outcome.value || row.dataset.outcome === outcome.value) &&
          (!scenario.value || row.dataset.scenario === scenario.value) &&
          sought.every((part) => contents.get(row).includes(part));
        row.hidden = !wanted;
        shown += wanted;
      }
      first(".count", filters).textContent = `${shown} of ${rows.length} shown`;
    };
    filters.addEventListener("input", filter);
    filters.addEventListener("submit", (event) => event.preventDefault());
    filters.addEventListener("reset", () => setTimeout(filter));
    filter();

    const headings = all("thead th", table);
    const key = (row, column) => {
      const text = row.cells[column].textContent.trim();
      const number = Number.parseFloat(text);
      return headings[column].classList.contains("number") ? (Number.isNaN(number) ? Infinity : number) : text;
    };
    const sort = (column) => {
      const rising = headings[column].ariaSort !== "ascending";
      headings.forEach((heading) => heading.removeAttribute("aria-sort"));
      headings[column].ariaSort = rising ? "ascending" : "descending";
      const sorted = rows
        .map((row) => [key(row, column), row])
        .sort(([a], [b]) => (a < b ? -1 : a > b ? 1 : 0) * (rising ? 1 : -1));
      first("tbody", table).append(...sorted.map(([, row]) => row));
    };
    headings.forEach((heading, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...heading.childNodes);
      button.addEventListener("click", () => sort(column));
      heading.append(button);
    });
  }

  /* Plots ----------------------------------------------------------------------------------------------------- */

  /* A browser that cannot inflate the plotting script shows the drawings that are there without it. */
  if (!first("#plotly") || !window.DecompressionStream) return;
  const common = first("#plots") ? json(first("#plots")) : { panels: [], loops: [], strips: [] };
  const MISSING = 32767;
  const STATES = ["fill", "hold", "vent"];
  const ROWS = [1, 2, 3, 4];

  const bytesOf = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const inflated = (text) =>
    new Response(new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate")));

  /* Lines as `packing.py` writes them: differences of numbers, all low bytes before all high ones. */
  const unpacked = async ({ lines, data }) => {
    const bytes = new Uint8Array(await inflated(data).arrayBuffer());
    const half = bytes.length / 2;
    let at = 0;
    const numbers = (count) => {
      let sum = 0;
      return Array.from({ length: count }, () => {
        sum += ((bytes[at] | (bytes[at + half] << 8)) << 16) >> 16;
        at += 1;
        return sum;
      });
    };
    const curves = Object.entries(lines).map(([name, { count, x, y }]) => {
      const across = Float64Array.from(numbers(count), (number) => x[0] + x[1] * number);
      const up = Float64Array.from(numbers(count), (number) => (number === MISSING ? NaN : y[0] + y[1] * number));
      return [name, { x: across, y: up }];
    });
    return Object.fromEntries(curves);
  };

  const stopOf = async (element) => {
    const { over_time, loops, panels = common.panels, ...rest } = json(element);
    return { ...rest, panels, curves: await unpacked(over_time), loops: await unpacked(loops) };
  };

  /* The script is only inflated and run once a plot is looked at: until then it is text that costs nothing. */
  const run = async (deflated) => {
    const script = document.createElement("script");
    script.textContent = await inflated(deflated).text();
    document.head.append(script);
    return window.Plotly;
  };
  let running;
  const plotly = () => (running ??= run(first("#plotly").textContent));

  const line = ({ role, label, dotted }, extra) => ({
    type: "scatter",
    mode: "lines",
    name: label,
    meta: role,
    hoverinfo: "none",
    line: { color: colour(role), width: role === "train" ? 2.2 : 1.3, dash: dotted ? "dot" : "solid" },
    ...extra,
  });

  const axis = (extra) => ({
    gridcolor: colour("grid"),
    linecolor: colour("rule"),
    zeroline: false,
    mirror: true,
    showline: true,
    automargin: false,
    tickfont: { size: 11, color: colour("quiet") },
    ...extra,
  });

  const frame = (extra) => ({
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: getComputedStyle(document.body).fontFamily, size: 11, color: colour("quiet") },
    showlegend: false,
    modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("quiet"), activecolor: colour("ink") },
    ...extra,
  });

  /* The plots take markup in texts; ours are texts. */
  const plain = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

  const heading = (text, xref, yref) => ({
    text: plain(text), xref, yref, x: 0, y: 1, xanchor: "left", yanchor: "bottom", yshift: 2, showarrow: false,
    font: { size: 12, color: colour("ink") },
  });

  const MARK_COLOURS = { pass: "good", fail: "bad", inconclusive: "odd" };
  const inkOf = (mark) => colour(MARK_COLOURS[mark.status]);

  const shapeOf = (mark, xref, yref) => {
    const x0 = mark.x0 ?? 0;
    const x1 = mark.x1 ?? 1;
    const across = mark.x0 === null && mark.x1 === null ? `${xref} domain` : xref;
    const upright = { xref: across, yref: `${yref} domain`, x0, x1, y0: 0, y1: 1 };
    if (mark.kind === "instant") return { type: "line", ...upright, line: { color: inkOf(mark), width: 2 } };
    if (mark.y === null)
      return { type: "rect", layer: "below", ...upright, opacity: 0.75, line: { width: 0 },
               fillcolor: colour(mark.kind === "window" && mark.status === "fail" ? "bad-wash" : "window") };
    return { type: "line", xref: across, yref, x0, x1, y0: mark.y, y1: mark.y,
             line: { color: inkOf(mark), width: mark.kind === "mean" ? 2.6 : 1.5,
                     dash: mark.kind === "mean" ? "solid" : "dash" } };
  };

  /* A label stands behind its mark, else before it, and inside where there is room on neither side. */
  const labelOf = (mark, xref, yref, share) => {
    const end = mark.x1 === null ? 1 : share(mark.x1);
    const behind = mark.kind !== "band" && end < 0.75;
    const before = mark.kind !== "band" && !behind && share(mark.x0 ?? -Infinity) > 0.3;
    return {
      text: plain(mark.label),
      xref: mark.x1 === null ? `${xref} domain` : xref,
      x: before ? mark.x0 : mark.x1 ?? 1,
      xanchor: behind ? "left" : "right",
      xshift: behind ? 5 : -5,
      yref: mark.y === null ? `${yref} domain` : yref,
      y: mark.y ?? (mark.kind === "window" ? 0.02 : 0.98),
      yanchor: mark.y === null ? (mark.kind === "window" ? "bottom" : "top")
        : behind || before || mark.kind === "interval" ? "middle" : "bottom",
      showarrow: false,
      bgcolor: mark.y === null && mark.kind !== "instant" ? "rgba(0,0,0,0)" : colour("paper"),
      borderpad: 1,
      font: { size: 11, color: inkOf(mark) },
    };
  };

  const place = (mark, xaxis, yaxis) => ({
    type: "scatter", mode: "markers", x: [mark.x0], y: [mark.y], xaxis, yaxis, hoverinfo: "none", name: mark.criterion,
    marker: { symbol: "circle-open", size: 10, color: inkOf(mark), line: { width: 2 } },
  });

  const addMark = (mark, traces, layout, x, y, share) => {
    if (mark.kind === "point") traces.push(place(mark, x, y));
    else if (mark.kind !== "interval") layout.shapes.push(shapeOf(mark, x, y));
    if (mark.label) layout.annotations.push(labelOf(mark, x, y, share));
  };

  /* Bars as one filled line with gaps: a shape each would take seconds. Its edge keeps the shortest in sight. */
  const bars = (kind, spans, fill, yaxis, half, extra) => ({
    type: "scatter", mode: "lines", fill: "toself", fillcolor: fill, line: { color: fill, width: 1, simplify: false },
    x: spans.flatMap(([from, to]) => [from, to, to, from, from, null]),
    y: spans.flatMap(([, , row]) => [row - half, row - half, row + half, row + half, row - half, null]),
    xaxis: "x", yaxis, hoverinfo: "skip", name: kind, ...extra,
  });

  /* When the valve of a wheelset is in one of some states; such states that follow at once are one span. */
  const spansOf = (stop, n, wanted) => {
    const { x, y } = stop.curves[`valve_command_${n}`] ?? { x: [], y: [] };
    const spans = [];
    Array.from(y, Math.round).forEach((state, k) => {
      const to = x[k + 1] ?? stop.end;
      if (!wanted.includes(state)) return;
      if (spans.length && spans.at(-1)[1] === x[k]) spans.at(-1)[1] = to;
      else spans.push([x[k], to]);
    });
    return spans;
  };

  const magnetBars = (stop, { label, offset, states }, n, yaxis) => {
    const spans = spansOf(stop, n, states).map((span) => [...span, n + offset]);
    const extra = { meta: `wheelset-${n}`, opacity: label === "hold" ? 0.6 : 1 };
    return bars(label, spans, colour(`wheelset-${n}`), yaxis, 0.17, extra);
  };

  const stripBars = (stop, { key, lanes }, yaxis) => {
    const magnets = ROWS.flatMap((n) => lanes.map((lane) => magnetBars(stop, lane, n, yaxis)));
    const marked = stop.marks.filter((mark) => mark.plot === key && mark.kind === "interval");
    const kinds = [...new Set(marked.map((mark) => mark.status))];
    const intervals = kinds.map((status) => {
      const own = marked.filter((mark) => mark.status === status);
      const ink = colour(MARK_COLOURS[status] + (lanes.length ? "-wash" : ""));
      return bars("interval", own.map((mark) => [mark.x0, mark.x1, mark.y]), ink, yaxis, 0.46);
    });
    return [...intervals, ...magnets].filter((each) => each.x.length);
  };

  /* Panels with the strips below each of them, then the other strips; those with nothing to show left out. */
  const plotsOverTime = (stop) => {
    const strips = common.strips.filter((strip) => stripBars(stop, strip, "y").length);
    const under = (panel) => strips.filter((strip) => strip.below === panel.key);
    const shown = (panel) => panel.lines.some((each) => each.series in stop.curves);
    const placed = stop.panels.flatMap((panel) => [...(shown(panel) ? [panel] : []), ...under(panel)]);
    return [...placed, ...strips.filter((strip) => !placed.includes(strip))];
  };

  /* Panels above each other share one time axis; a gap of 26 pixels holds the title of the next. */
  const panelsFigure = (stop) => {
    const plots = plotsOverTime(stop);
    const heights = plots.map((plot) => (plot.lines ? 112 * plot.height : Math.max(72, 13 * plot.rows.length)));
    const gap = 26;
    const total = heights.reduce((sum, height) => sum + height + gap, 0);
    const share = (time) => (time - stop.start) / (stop.end - stop.start || 1);
    /* An open end of a mark is the end of the record, so that zooming keeps it in its place. */
    const marks = stop.marks.map((mark) =>
      mark.y !== null && (mark.x0 === null) !== (mark.x1 === null)
        ? { ...mark, x0: mark.x0 ?? stop.start, x1: mark.x1 ?? stop.end }
        : mark,
    );
    const traces = [];
    const layout = { shapes: [], annotations: [] };
    let top = 1;
    const domainOf = (height) => {
      const upper = top - gap / total;
      top = upper - height / total;
      return [Math.max(top, 0), upper];
    };
    const addPlot = (k, key, title, yaxis) => {
      const y = k ? `y${k + 1}` : "y";
      layout[`yaxis${k ? k + 1 : ""}`] = axis({ domain: domainOf(heights[k]), ...yaxis });
      layout.annotations.push(heading(title, "x domain", `${y} domain`));
      for (const mark of marks.filter((mark) => mark.plot === key)) addMark(mark, traces, layout, "x", y, share);
      return y;
    };
    plots.forEach((plot, k) => {
      const y = k ? `y${k + 1}` : "y";
      if (plot.lines) {
        for (const each of plot.lines)
          if (each.series in stop.curves) traces.push(line(each, { ...stop.curves[each.series], xaxis: "x", yaxis: y }));
        addPlot(k, plot.key, `${plot.title}, ${plot.unit}`, { nticks: 5, autorangeoptions: { include: plot.include } });
        return;
      }
      traces.push(...stripBars(stop, plot, y));
      const [tickvals, ticktext] = [plot.rows.map(([row]) => row), plot.rows.map(([, label]) => label)];
      addPlot(k, plot.key, plot.heading, { fixedrange: true, tickvals, ticktext, range: [4.5, 0.5], showgrid: plot.lanes.length > 0 });
    });
    layout.xaxis = axis({
      anchor: `y${heights.length > 1 ? heights.length : ""}`, range: [stop.start, stop.end],
      title: { text: "time since the brake command, s", font: { size: 11, color: colour("quiet") }, standoff: 6 },
      showspikes: true, spikemode: "across", spikesnap: "cursor", spikethickness: 1, spikedash: "solid",
      spikecolor: colour("quiet"),
    });
    return { traces, layout: frame({ ...layout, height: total + 40, hovermode: "x", hoverdistance: -1,
      dragmode: "zoom", margin: { l: 44, r: 8, t: 0, b: 40 } }) };
  };

  const dots = (loop, { role }) => (loop.dots ? { mode: "markers", marker: { color: colour(role), size: 2.5 } } : {});

  const loopsFigure = (stop, width) => {
    const traces = [];
    const drawn = common.loops.filter((loop) => loop.lines.some((each) => `${loop.key} ${each.series}` in stop.loops));
    const count = drawn.length;
    const stacked = width < 640;
    const grid = { pattern: "independent", xgap: 0.16, ygap: 0.24, rows: stacked ? count : 1, columns: stacked ? 1 : count };
    const layout = { shapes: [], annotations: [], grid };
    drawn.forEach((loop, k) => {
      const tail = k ? k + 1 : "";
      for (const each of loop.lines) {
        const curve = stop.loops[`${loop.key} ${each.series}`];
        if (curve) traces.push(line(each, { ...curve, opacity: 0.75, ...dots(loop, each), xaxis: `x${tail}`, yaxis: `y${tail}` }));
      }
      layout[`xaxis${tail}`] = axis({ nticks: 6, autorangeoptions: { include: loop.include }, title: { text: loop.across_title, font: { size: 11 }, standoff: 4 } });
      layout[`yaxis${tail}`] = axis({ nticks: 6, title: { text: loop.up_title, font: { size: 11 }, standoff: 4 }, automargin: true });
      layout.annotations.push(heading(loop.title, `x${tail} domain`, `y${tail} domain`));
      for (const mark of stop.marks.filter((mark) => mark.plot === loop.key))
        addMark(mark, traces, layout, `x${tail}`, `y${tail}`, () => 1);
    });
    return { traces, layout: frame({ ...layout, height: stacked ? 270 * count : 300, hovermode: false, margin: { l: 52, r: 8, t: 24, b: 44 } }) };
  };

  const config = {
    displaylogo: false,
    responsive: true,
    modeBarButtons: [["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d", "toImage"]],
  };

  const text = (value, decimals) =>
    Number.isFinite(value) ? value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1") : "–";
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

  /* The cursor: moved by the pointer over the plots or, with the keyboard, by the slider. */
  const cursor = (plots, stop, panels) => {
    const slider = first(".readout input", plots);
    const output = first(".readout output", plots);
    const body = first(".readout tbody", plots);
    const train = first(".train-readout", plots);
    const mark = document.createElement("div");
    mark.className = "cursor-line";
    panels.append(mark);

    const cell = (row, tag, content) => {
      const element = document.createElement(tag);
      element.textContent = content;
      row.append(element);
      return element;
    };
    const cells = [];
    const build = (label, read) => {
      const row = body.insertRow();
      cell(row, "th", label).scope = "row";
      for (const n of ROWS) cells.push([cell(row, "td", ""), (time) => read(n, time)]);
    };
    const { curves } = stop;
    for (const [name, label, decimals] of WHEELSET_ROWS)
      if (`${name}_1` in curves) build(label, (n, time) => text(valueAt(curves[`${name}_${n}`], time), decimals));
    if ("valve_command_1" in curves)
      build("valve", (n, time) => STATES[Math.round(stateAt(curves[`valve_command_${n}`], time))] ?? "–");
    for (const [name, label, decimals] of TRAIN_ROWS)
      if (name in curves) {
        const row = document.createElement("div");
        train.append(row);
        cell(row, "dt", label);
        cells.push([cell(row, "dd", ""), (time) => text(valueAt(curves[name], time), decimals)]);
      }

    let at = stop.start;
    const put = () => {
      const { _size: size, xaxis } = panels._fullLayout;
      const x = xaxis.l2p(at);
      mark.hidden = x < 0 || x > xaxis._length;
      mark.style.cssText = `left:${xaxis._offset + x}px;top:${size.t}px;height:${size.h}px`;
    };
    const show = (time) => {
      at = Math.max(stop.start, Math.min(time, stop.end));
      slider.value = (slider.max * (at - stop.start)) / (stop.end - stop.start || 1);
      slider.setAttribute("aria-valuetext", `${text(at, 2)} seconds`);
      output.textContent = `${text(at, 2)} s`;
      for (const [element, read] of cells) element.textContent = read(at);
      put();
    };
    slider.addEventListener("input", () =>
      show(stop.start + (slider.value / slider.max) * (stop.end - stop.start)));
    panels.on("plotly_hover", ({ xvals }) => show(xvals[0]));
    panels.on("plotly_afterplot", put);
    const worthwhile = (mark) => mark.status !== "pass" || mark.kind === "window";
    const start = stop.marks.find((mark) => mark.plot !== "over-distance" && mark.x0 !== null && worthwhile(mark));
    show(start ? start.x0 : stop.start);
  };

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

  /* The height of a line as it is drawn; to its end it stays at its last point. */
  const valueAt = (curve, time) => {
    if (!curve) return NaN;
    const { x, y } = curve;
    const k = rowAt(x, time);
    if (k + 1 >= x.length || time <= x[k]) return y[k];
    return y[k] + ((time - x[k]) / (x[k + 1] - x[k])) * (y[k + 1] - y[k]);
  };

  const toggleRoles = (Plotly, plots, figures) => {
    const apply = () => {
      const hidden = new Set(all(".key input:not(:checked)", plots).map((box) => box.dataset.role));
      for (const path of all(".sketch .line, .sketch .magnet", plots))
        path.style.display = [...hidden].some((role) => path.classList.contains(`role-${role}`)) ? "none" : "";
      for (const figure of figures)
        Plotly.restyle(figure, { visible: figure.data.map((trace) => !hidden.has(trace.meta)) });
    };
    first(".key", plots).addEventListener("change", apply);
    return apply;
  };

  const draw = async (plots) => {
    if (plots.dataset.drawn) return;
    plots.dataset.drawn = "yes";
    const Plotly = await plotly();
    const stop = await stopOf(first(`script.trace[data-case="${plots.dataset.case}"]`));
    const panels = first(".panels-plot", plots);
    const loops = first(".loops-plot", plots);
    const figures = [[panels, panelsFigure], [loops, loopsFigure]].filter(([element]) => element);
    for (const [element] of figures) element.hidden = false;
    for (const each of all(".sketch", plots)) each.hidden = true;
    const paint = () => {
      for (const [element, figure] of figures) {
        const { traces, layout } = figure(stop, plots.clientWidth);
        Plotly.react(element, traces, layout, { ...config, displayModeBar: plots.clientWidth > 600 });
      }
    };
    paint();
    if (first(".readout", plots)) cursor(plots, stop, panels);
    const roles = toggleRoles(Plotly, plots, figures.map(([element]) => element));
    redraw.push(() => {
      paint();
      roles();
    });
  };

  all(".plots.overlay").forEach(draw);
  const lookAt = (details) => details.open && all(".plots", details).forEach(draw);
  for (const details of all("details.stop")) {
    details.addEventListener("toggle", () => lookAt(details));
    requestAnimationFrame(() => setTimeout(() => lookAt(details)));
  }
  const openTarget = () => {
    const target = location.hash && document.getElementById(location.hash.slice(1));
    if (target instanceof HTMLDetailsElement) {
      target.open = true;
      target.scrollIntoView();
    }
  };
  addEventListener("hashchange", openTarget);
  openTarget();
})();
