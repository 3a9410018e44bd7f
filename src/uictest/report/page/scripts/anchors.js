/* What a link leads to is unfolded, and so is what it lies in; a row that is filtered away is shown again. */
const showTarget = () => {
  const place = target(location.hash);
  if (!place) return;
  for (let each = place.closest("details"); each; each = each.parentElement.closest("details")) each.open = true;
  if (place.matches("tr[hidden]")) filters.reset();
  requestAnimationFrame(() => setTimeout(() => place.scrollIntoView({ behavior: "instant" })));
};
addEventListener("hashchange", showTarget);
showTarget();
