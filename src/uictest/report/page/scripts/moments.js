/* The buttons that show where the value of a criterion was taken: cursor, light band, ring around the value. */
const ring = (panels) => {
  const circle = panels.appendChild(make("div", "", { class: "ring" }));
  circle.hidden = true;
  let at = null;
  const put = () => {
    const place = at && panels.placeOf(at.plot, at.wheelset);
    circle.hidden = !place || at.value === null;
    if (circle.hidden) return;
    const { [place.x]: x, [place.y]: y } = panels._fullLayout;
    const [left, top] = [x.l2p(at.time), y.l2p(at.value)];
    circle.hidden = left < 0 || left > x._length || top < 0 || top > y._length;
    circle.style.cssText = `left:${x._offset + left}px;top:${y._offset + top}px`;
  };
  panels.on("plotly_afterplot", put);
  return (moment) => {
    at = moment;
    put();
  };
};

const offerMoments = (within, panels, show) => {
  const band = uprights(panels, "spotlight");
  const encircle = ring(panels);
  const buttons = all("button.moment", within);
  for (const button of buttons)
    button.addEventListener("click", () => {
      const again = button.getAttribute("aria-pressed") === "true";
      for (const each of buttons) each.setAttribute("aria-pressed", String(each === button && !again));
      if (again) {
        band(null);
        encircle(null);
        return;
      }
      const { plot, start, end, wheelset, value } = button.dataset;
      band(Number(start), Number(end));
      encircle({ plot, time: Number(start), wheelset: Number(wheelset), value: value === "" ? null : Number(value) });
      show(Number(start));
      panels.scrollIntoView({ block: "nearest" });
    });
  for (const button of buttons) button.setAttribute("aria-pressed", "false");
  for (const row of all(".vents tbody tr", within)) {
    const [start, wheelset, duration] = [...row.cells].map((cell) => cell.textContent);
    const button = make("button", start, { type: "button", "aria-label": `Show the vent of wheelset ${wheelset} at ${start} s` });
    row.cells[0].replaceChildren(button);
    button.addEventListener("click", () => {
      band(Number(start), Number(start) + Number(duration));
      encircle(null);
      show(Number(start));
      panels.scrollIntoView({ block: "nearest" });
    });
  }
};
