/* The plots of a stop: drawn once it is looked at, and again when appearance or view change. */
const redraw = [];
const repaint = () => redraw.forEach((paint) => paint());

const hiddenRoles = (plots) => new Set(all(".key input[data-role]:not(:checked)", plots).map((box) => box.dataset.role));
const chosen = (plots, name) => first(`select[data-choice="${name}"]`, plots)?.value ?? "";

const hideInDrawing = (plots) => {
  const hidden = [...hiddenRoles(plots)];
  for (const path of all(".drawing .line, .drawing .magnet, .drawing .band", plots))
    path.style.display = hidden.some((role) => path.classList.contains(`role-${role}`)) ? "none" : "";
};

const drawn = new WeakMap();
const draw = (plots) => {
  if (!drawn.has(plots)) drawn.set(plots, drawOnce(plots));
  return drawn.get(plots);
};

const drawOnce = async (plots) => {
  const stop = await stopOf(plots.nextElementSibling);
  const panels = first(".panels-plot", plots);
  const slider = first(".readout input", plots);
  for (const each of [panels, ...all(".js-plot", plots)]) each.hidden = false;
  for (const each of all(".drawing", plots)) each.hidden = true;
  let axis = axisOver(stop, "time");
  let at = stop.start;
  const reading = readout(plots, stop);
  const loops = loopPlots(first(".loops-plot", plots), stop);
  const show = (time) => {
    at = Math.max(stop.start, Math.min(time, stop.end));
    slider.value = (slider.max * (at - stop.start)) / (stop.end - stop.start || 1);
    slider.setAttribute("aria-valuetext", `${text(at, 2)} seconds`);
    first(".readout output", plots).textContent = `${text(at, 2)} s`;
    view.show("cursor-line", axis.at(at));
    reading.show(at);
    loops.show(at);
  };
  const pin = (time) => {
    reading.pin(time);
    view.show("pinned-line", time === null ? null : axis.at(time));
  };
  const view = viewer(panels, {
    moved: (x) => show(axis.time(x)),
    pinned: (x) => pin(axis.time(x)),
    ranged: ([low, high]) => loops.within(axis.time(low), axis.time(high)),
  });
  const apart = () => chosen(plots, "view") === "apart" && plots.clientWidth > 640;
  const light = offerMoments(plots.closest("details"), { view, axis: () => axis, show });
  const paintPanels = () => {
    view.paint(figureOf(stop, axis, apart(), hiddenRoles(plots)));
    pin(reading.pinned());
    light();
    show(at);
  };
  const paintLoops = () => loops.paint(Number(chosen(plots, "wheelset") || 1));
  const paint = () => {
    paintPanels();
    paintLoops();
  };
  const decides = all("button.moment", plots.closest("details")).find(({ dataset }) => dataset.status !== "pass" && dataset.wheelset);
  if (decides) first('[data-choice="wheelset"]', plots).value = decides.dataset.wheelset;
  paint();
  redraw.push(paint);
  const worthwhile = ({ status, kind, along, x0 }) => x0 !== null && along === "time" && (status !== "pass" || ["window", "fault"].includes(kind));
  show(stop.marks.find(worthwhile)?.x0 ?? stop.start);
  offerTables(first(".tables", plots), stop);

  slider.addEventListener("input", () => show(stop.start + (slider.value / slider.max) * (stop.end - stop.start)));
  first("button.pin", plots).addEventListener("click", () => pin(at));
  first("button.unpin", plots).addEventListener("click", () => pin(null));
  offerZoom(first(".zoom", plots), view);
  for (const option of all('[data-choice="across"] option', plots)) option.disabled = axisOver(stop, option.value).name !== option.value;
  first('[data-choice="view"]', plots).addEventListener("change", paintPanels);
  first('[data-choice="wheelset"]', plots).addEventListener("change", paintLoops);
  first('[data-choice="across"]', plots).addEventListener("change", ({ target: choice }) => {
    const [low, high] = view.inView().map((x) => axis.time(x));
    const whole = low <= stop.start && high >= stop.end;
    axis = axisOver(stop, choice.value);
    choice.value = axis.name;
    for (const box of all('[data-role="band"]', plots)) box.disabled = axis.name !== "time";
    paintPanels();
    if (!whole) view.zoom(axis.at(low), axis.at(high));
  });
  first(".key", plots).addEventListener("change", ({ target: box }) => {
    if (!box.dataset.role) return;
    hideInDrawing(plots);
    paintPanels();
  });
  plots.dataset.ready = "yes";
  settle();
};

/* Buttons for what dragging and a double click do. */
const offerZoom = (place, view) => {
  const steps = { in: [0.5], out: [2], back: [1, -0.25], on: [1, 0.25] };
  for (const button of all("button", place))
    button.addEventListener("click", () => (steps[button.value] ? view.scale(...steps[button.value]) : view.all()));
};

/* The drawings stand in for the plots until these come near the window. */
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
    aim(() => stop.scrollIntoView());
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
