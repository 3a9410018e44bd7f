/* The buttons that show where the value of a criterion was taken: cursor, light band, ring around the value. */
const offerMoments = (within, { view, axis, show }) => {
  const buttons = all("button.moment", within);
  let lit = null;
  const light = () => {
    const { plot, start, end, wheelset, value } = lit ?? {};
    if (lit) view.show("spotlight", axis().at(start), axis().at(end));
    else view.show("spotlight", null);
    view.ring(lit && { key: plot, wheelset, x: axis().at(start), y: value });
  };
  const go = (moment) => {
    lit = moment;
    light();
    if (!moment) return;
    const [low, high] = view.inView();
    const x = axis().at(moment.start);
    if (x < low || x > high) view.all();
    show(moment.seen ?? moment.start);
    aim(() => view.panelOf(moment).scrollIntoView({ block: "nearest" }));
  };
  const press = (button) => {
    for (const each of buttons) each.setAttribute("aria-pressed", String(each === button));
  };
  for (const button of buttons)
    button.addEventListener("click", () => {
      const again = button.getAttribute("aria-pressed") === "true";
      press(again ? null : button);
      const { plot, start, end, seen, wheelset, value } = button.dataset;
      go(again ? null : {
        plot, start: Number(start), end: Number(end), seen: Number(seen), wheelset: Number(wheelset), value: value === "" ? null : Number(value),
      });
    });
  press(null);
  for (const row of all(".vents tbody tr", within)) {
    const [start, wheelset, duration] = [...row.cells].map((cell) => cell.textContent);
    const button = make("button", start, { type: "button", "aria-label": `Show the vent of wheelset ${wheelset} at ${start} s` });
    row.cells[0].replaceChildren(button);
    button.addEventListener("click", () => {
      press(null);
      go({ start: Number(start), end: Number(start) + Number(duration), value: null });
    });
  }
  return light;
};
