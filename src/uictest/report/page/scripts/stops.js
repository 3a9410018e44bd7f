/* The plots of a stop: drawn once it is looked at, and again when appearance or view change. */
const redraw = [];
const repaint = () => redraw.forEach((paint) => paint());

const hiddenRoles = (plots) => new Set(all(".key input[data-role]:not(:checked)", plots).map((box) => box.dataset.role));

const hideInSketches = (plots) => {
  const hidden = hiddenRoles(plots);
  for (const path of all(".sketch .line, .sketch .magnet", plots))
    path.style.display = [...hidden].some((role) => path.classList.contains(`role-${role}`)) ? "none" : "";
};

/* Draws a figure into its place, or what has changed of it. */
const paintFigure = (Plotly, plots, element, { traces, layout }) => {
  const hidden = hiddenRoles(plots);
  const shown = traces.map((trace) => (hidden.has(trace.meta) ? { ...trace, visible: false } : trace));
  return Plotly.react(element, shown, layout, configOf(element.clientWidth));
};

const chosen = (plots, name) => first(`select[data-choice="${name}"]`, plots)?.value ?? "";

/* Axes of the panel that shows a wheelset (0: the train) in the plot `key`. */
const placesIn = (stop, apart) => (key, wheelset) => {
  const row = plotsOverTime(stop).findIndex((plot) => plot.key === key);
  if (row < 0) return null;
  const column = apart() && wheelset ? wheelset : 1;
  const axisName = (letter, number) => `${letter}axis${number > 1 ? number : ""}`;
  return { x: axisName("x", column), y: axisName("y", row * (apart() ? ROWS.length : 1) + column) };
};

const drawn = new WeakMap();
const draw = (plots) => {
  if (!drawn.has(plots)) drawn.set(plots, drawOnce(plots));
  return drawn.get(plots);
};

const drawOnce = async (plots) => {
  plots.dataset.drawn = "yes";
  const Plotly = await plotly();
  const stop = await stopOf(plots.nextElementSibling);
  const panels = first(".panels-plot", plots);
  const loops = first(".loops-plot", plots);
  const apart = () => chosen(plots, "view") === "apart" && plots.clientWidth > 640;
  const wheelset = () => Number(chosen(plots, "wheelset") || 1);
  const paintPanels = () => paintFigure(Plotly, plots, panels, panelsFigure(stop, panels.clientWidth, apart()));
  const paintLoops = () => paintFigure(Plotly, plots, loops, loopsFigure(stop, loops.clientWidth, wheelset()));
  const paint = () => Promise.all([paintPanels(), paintLoops()]);
  for (const element of [panels, loops]) element.hidden = false;
  for (const each of all(".sketch", plots)) each.hidden = true;
  panels.placeOf = placesIn(stop, apart);
  await paint();
  redraw.push(paint);
  const dots = loopDots(loops, stop, wheelset);
  const show = cursor(plots, stop, panels, [dots]);
  offerMoments(plots.closest("details"), panels, show);
  offerTables(first(".tables", plots), stop);
  first('[data-choice="view"]', plots).addEventListener("change", paintPanels);
  first('[data-choice="wheelset"]', plots).addEventListener("change", paintLoops);
  first(".key", plots).addEventListener("change", ({ target: box }) => {
    if (!box.dataset.role) return;
    hideInSketches(plots);
    paint();
  });
  plots.dataset.ready = "yes";
};

/* The drawings stand in for the plots until these come near the window: their script takes a second to run. */
if (canPlot) {
  const near = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target: plots } of entries) if (isIntersecting) setTimeout(() => draw(plots));
  }, { rootMargin: "50% 0px" });
  for (const plots of all("details.stop .plots")) near.observe(plots);
}

/* From what stands first on the page to the instant in the plots of the stop. */
for (const link of all("a[data-criterion]"))
  link.addEventListener("click", async (event) => {
    const stop = target(link.hash);
    if (!canPlot || !stop) return;
    event.preventDefault();
    history.pushState(null, "", link.hash);
    stop.open = true;
    stop.scrollIntoView({ behavior: "instant" });
    await draw(first(".plots", stop));
    const button = all("button.moment", stop).find((each) => each.dataset.criterion === link.dataset.criterion);
    if (button.getAttribute("aria-pressed") !== "true") button.click();
  });

/* Labels keep apart in pixels: another width needs other rows of them. */
let resized;
let drawnWidth = innerWidth;
addEventListener("resize", () => {
  clearTimeout(resized);
  resized = setTimeout(() => {
    if (innerWidth !== drawnWidth) repaint();
    drawnWidth = innerWidth;
  }, 200);
});
