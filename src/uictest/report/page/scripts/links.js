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

/* Buttons that copy a text: the link to a case, the command that runs it. */
const copied = async (text) => {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    /* A page that was opened from a file may not use the clipboard in every browser. */
    const area = make("textarea", text, { readonly: "", class: "unseen" });
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
};

const textToCopy = (button) => button.dataset.copy ?? location.href.split("#")[0] + button.dataset.fragment;

for (const button of all("button.copy")) {
  const label = button.textContent;
  button.addEventListener("click", async () => {
    const text = textToCopy(button);
    const done = await copied(text);
    button.focus();
    first(".copied", button.closest(".tools")).textContent = done ? `${label.replace("Copy", "Copied")}.` : text;
  });
}
