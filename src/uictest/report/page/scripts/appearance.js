/* Light or dark. Plots take their colours when they are drawn, and are drawn again. */
for (const choice of all('input[name="theme"]'))
  choice.addEventListener("change", () => {
    if (choice.value === "auto") delete root.dataset.theme;
    else root.dataset.theme = choice.value;
    repaint();
  });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => repaint());

/* A colour of the style sheet, or so many per cent of it, as the browser computes it: what the plots can take. */
const probe = document.createElement("i");
probe.hidden = true;
document.body.append(probe);
const colour = (name, share = 100) => {
  probe.style.color = share < 100 ? `color-mix(in srgb, var(--${name}) ${share}%, transparent)` : `var(--${name})`;
  return getComputedStyle(probe).color;
};
