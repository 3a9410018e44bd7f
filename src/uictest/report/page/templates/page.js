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
  const common = first("#plots") ? json(first("#plots")) : { panels: [], loops: [] };
  const MISSING = 65535;
  const STATES = ["fill", "hold", "vent"];

  const unpacked = ({ offset, step, data }) => {
    const bytes = Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Float64Array.from({ length: bytes.length / 2 }, (_, k) => {
      const number = view.getUint16(2 * k, true);
      return number === MISSING ? NaN : offset + step * number;
    });
  };

  const stopOf = (element) => {
    const { time, series, marks, panels = common.panels } = json(element);
    const known = Object.entries(series).map(([name, packed]) => [name, unpacked(packed)]);
    return { time: unpacked(time), series: Object.fromEntries(known), marks, panels };
  };

  /* The script is only inflated and run once a plot is looked at: until then it is text that costs nothing. */
  const run = async (deflated) => {
    const bytes = Uint8Array.from(atob(deflated), (character) => character.charCodeAt(0));
    const script = document.createElement("script");
    const inflated = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    script.textContent = await new Response(inflated).text();
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

  const shapeOf = (mark, xref, yref) => {
    const x0 = mark.x0 ?? 0;
    const x1 = mark.x1 ?? 1;
    const across = mark.x0 === null && mark.x1 === null ? `${xref} domain` : xref;
    if (mark.y === null)
      return { type: "rect", layer: "below", xref: across, yref: `${yref} domain`, x0, x1, y0: 0, y1: 1,
               fillcolor: colour("window"), opacity: 0.75, line: { width: 0 } };
    return { type: "line", xref: across, yref, x0, x1, y0: mark.y, y1: mark.y,
             line: { color: colour("limit"), width: mark.kind === "found" ? 2.6 : 1.5,
                     dash: mark.kind === "found" ? "solid" : "dash" } };
  };

  const labelOf = (mark, xref, yref) => ({
    text: plain(mark.label),
    xref: mark.x1 === null ? `${xref} domain` : xref,
    x: mark.x1 ?? 1,
    xanchor: mark.x1 === null || mark.kind === "band" ? "right" : "left",
    yref: mark.y === null ? `${yref} domain` : yref,
    y: mark.y ?? (mark.kind === "band" ? 0.98 : 0.02),
    yanchor: mark.kind === "band" ? "top" : mark.y === null || mark.x1 === null ? "bottom" : "middle",
    showarrow: false,
    bgcolor: mark.y === null ? "rgba(0,0,0,0)" : colour("paper"),
    borderpad: 1,
    font: { size: 11, color: colour("limit") },
  });

  /* Panels above each other share one time axis; a gap of 24 pixels holds the title of the next. */
  const panelsFigure = (stop) => {
    const panels = stop.panels.filter((panel) => panel.lines.some((each) => each.series in stop.series));
    const valves = [1, 2, 3, 4].map((n) => stop.series[`valve_command_${n}`]);
    const heights = panels.map((panel) => 112 * panel.height);
    if (valves[0]) heights.push(72);
    const gap = 26;
    const total = heights.reduce((sum, height) => sum + height + gap, 0);
    const last = stop.time[stop.time.length - 1];
    /* An open end of a mark is the end of the record, so that zooming keeps it in its place. */
    const marks = stop.marks.map((mark) =>
      mark.y !== null && (mark.x0 === null) !== (mark.x1 === null)
        ? { ...mark, x0: mark.x0 ?? stop.time[0], x1: mark.x1 ?? last }
        : mark,
    );
    const traces = [];
    const layout = { shapes: [], annotations: [] };
    let top = 1;
    const place = (height) => {
      const upper = top - gap / total;
      top = upper - height / total;
      return [Math.max(top, 0), upper];
    };
    panels.forEach((panel, k) => {
      const y = k ? `y${k + 1}` : "y";
      layout[`yaxis${k ? k + 1 : ""}`] = axis({
        domain: place(heights[k]), nticks: 5, autorangeoptions: { include: panel.include },
      });
      for (const each of panel.lines)
        if (each.series in stop.series)
          traces.push(line(each, { x: stop.time, y: stop.series[each.series], xaxis: "x", yaxis: y }));
      layout.annotations.push(heading(`${panel.title}, ${panel.unit}`, "x domain", `${y} domain`));
      for (const mark of marks.filter((mark) => mark.plot === panel.key)) {
        layout.shapes.push(shapeOf(mark, "x", y));
        if (mark.label) layout.annotations.push(labelOf(mark, "x", y));
      }
    });
    if (valves[0]) {
      const k = panels.length + 1;
      layout[`yaxis${k}`] = axis({ domain: place(72), fixedrange: true, tickvals: [1, 2, 3, 4], autorange: "reversed" });
      layout.annotations.push(heading("WSP valves: hold (faint), vent (strong)", "x domain", `y${k} domain`));
      const [hold, vent] = [colour("hold"), colour("vent")];
      traces.push({
        type: "heatmap", x: stop.time, y: [1, 2, 3, 4], z: valves.map((valve) => Array.from(valve, Math.round)),
        xaxis: "x", yaxis: `y${k}`, zmin: 0, zmax: 2, showscale: false, ygap: 4, hoverinfo: "none", name: "valves",
        colorscale: [[0, "rgba(0,0,0,0)"], [0.33, "rgba(0,0,0,0)"], [0.34, hold], [0.66, hold], [0.67, vent], [1, vent]],
      });
    }
    layout.xaxis = axis({
      anchor: valves[0] ? `y${panels.length + 1}` : `y${panels.length}`, range: [stop.time[0], last],
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
    const count = common.loops.length;
    const stacked = width < 640;
    const grid = { pattern: "independent", xgap: 0.16, ygap: 0.24, rows: stacked ? count : 1, columns: stacked ? 1 : count };
    const layout = { shapes: [], annotations: [], grid };
    common.loops.forEach((loop, k) => {
      const tail = k ? k + 1 : "";
      loop.lines.forEach((each, n) => {
        const across = loop.of_wheelsets ? `${loop.across}_${n + 1}` : loop.across;
        if (across in stop.series && each.series in stop.series)
          traces.push(line(each, { x: stop.series[across], y: stop.series[each.series], opacity: 0.75, ...dots(loop, each), xaxis: `x${tail}`, yaxis: `y${tail}` }));
      });
      layout[`xaxis${tail}`] = axis({ nticks: 6, autorangeoptions: { include: loop.include }, title: { text: loop.across_title, font: { size: 11 }, standoff: 4 } });
      layout[`yaxis${tail}`] = axis({ nticks: 6, title: { text: loop.up_title, font: { size: 11 }, standoff: 4 }, automargin: true });
      layout.annotations.push(heading(loop.title, `x${tail} domain`, `y${tail} domain`));
      for (const mark of stop.marks.filter((mark) => mark.plot === loop.key)) {
        layout.shapes.push(shapeOf(mark, `x${tail}`, `y${tail}`));
        layout.annotations.push(labelOf(mark, `x${tail}`, `y${tail}`));
      }
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
      for (const n of [1, 2, 3, 4]) cells.push([cell(row, "td", ""), (k) => read(n, k)]);
    };
    for (const [name, label, decimals] of WHEELSET_ROWS)
      if (`${name}_1` in stop.series) build(label, (n, k) => text(stop.series[`${name}_${n}`]?.[k], decimals));
    if ("valve_command_1" in stop.series)
      build("valve", (n, k) => STATES[Math.round(stop.series[`valve_command_${n}`]?.[k])] ?? "–");
    for (const [name, label, decimals] of TRAIN_ROWS)
      if (name in stop.series) {
        const row = document.createElement("div");
        train.append(row);
        cell(row, "dt", label);
        cells.push([cell(row, "dd", ""), (k) => text(stop.series[name][k], decimals)]);
      }

    let at = 0;
    const put = () => {
      const { _size: size, xaxis } = panels._fullLayout;
      const x = xaxis.l2p(stop.time[at]);
      mark.hidden = x < 0 || x > xaxis._length;
      mark.style.cssText = `left:${xaxis._offset + x}px;top:${size.t}px;height:${size.h}px`;
    };
    const show = (k) => {
      at = Math.max(0, Math.min(k, stop.time.length - 1));
      slider.value = at;
      slider.setAttribute("aria-valuetext", `${text(stop.time[at], 2)} seconds`);
      output.textContent = `${text(stop.time[at], 2)} s`;
      for (const [element, read] of cells) element.textContent = read(at);
      put();
    };
    slider.max = stop.time.length - 1;
    slider.addEventListener("input", () => show(Number(slider.value)));
    panels.on("plotly_hover", ({ xvals }) => show(nearest(stop.time, xvals[0])));
    panels.on("plotly_afterplot", put);
    const start = stop.marks.find((mark) => mark.kind === "window");
    show(start ? nearest(stop.time, start.x0) : 0);
  };

  const nearest = (time, wanted) => {
    let low = 0;
    let high = time.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle] < wanted) low = middle;
      else high = middle;
    }
    return wanted - time[low] < time[high] - wanted ? low : high;
  };

  const toggleRoles = (Plotly, plots, figures) => {
    const apply = () => {
      const hidden = new Set(all(".key input:not(:checked)", plots).map((box) => box.dataset.role));
      for (const path of all(".sketch .line", plots))
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
    const stop = stopOf(first(`script.trace[data-case="${plots.dataset.case}"]`));
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
