/* What a link leads to is unfolded, and so is what it lies in. */
const showTarget = () => {
  const place = target(location.hash);
  if (!place) return;
  for (let each = place.closest("details"); each; each = each.parentElement.closest("details")) each.open = true;
  place.scrollIntoView();
};
addEventListener("hashchange", showTarget);
showTarget();
