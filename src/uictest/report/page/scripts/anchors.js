/* Where a jump leads stays in place while plots around it are drawn, until the reader moves on. */
let settle = () => {};
const aim = (scroll) => {
  settle = scroll;
  settle();
};
for (const kind of ["wheel", "touchmove", "keydown", "pointerdown"]) addEventListener(kind, () => { settle = () => {}; }, { passive: true });

/* What a link leads to is unfolded, and so is what it lies in; a row that is filtered away is shown again. */
const showTarget = () => {
  const place = target(location.hash);
  if (!place) return;
  for (let each = place.closest("details"); each; each = each.parentElement.closest("details")) each.open = true;
  if (place.matches("tr[hidden]")) filters.reset();
  requestAnimationFrame(() => setTimeout(() => aim(() => place.scrollIntoView())));
};
addEventListener("hashchange", showTarget);
showTarget();
