/* A browser that cannot inflate the plotting script shows the drawings that are there without it. */
const canPlot = Boolean(first("#plotly") && window.DecompressionStream);
const common = first("#plots") ? json(first("#plots")) : { panels: [], loops: [], strips: [], quantities: {}, compared: [] };
const STATES = ["fill", "hold", "vent"];
const ROWS = [1, 2, 3, 4];

/* The script is only inflated and run once a plot is looked at: until then it is text that costs nothing. */
const run = async (deflated) => {
  const script = make("script", await inflated(deflated).text());
  document.head.append(script);
  return window.Plotly;
};
let running;
const plotly = () => (running ??= run(first("#plotly").textContent));

/* Line styles stand beside colours: a plot can be read in grey and by colour-blind eyes. */
const DASHES = { "wheelset-1": "solid", "wheelset-2": "7px,2px", "wheelset-3": "3px,2px", "wheelset-4": "8px,2px,2px,2px" };

const dashOf = ({ role, dotted }, alone) => (dotted ? "1px,2px" : (!alone && DASHES[role]) || "solid");

/* A line of a role in its colour; one that is `alone` in its panel needs no style of its own. */
const line = (each, extra, alone = false) => ({
  type: "scatter",
  mode: "lines",
  name: each.label,
  meta: each.role,
  hoverinfo: "none",
  line: { color: colour(each.role), width: each.role === "train" ? 2.2 : 1.3, dash: dashOf(each, alone) },
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

const config = {
  displaylogo: false,
  responsive: true,
  modeBarButtons: [["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d", "toImage"]],
};
const configOf = (width) => ({ ...config, displayModeBar: width > 600 });

/* The plots take markup in texts; ours are texts. */
const plain = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
