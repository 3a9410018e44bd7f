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
