/* Short names for what every part of the script needs of the page. */
const root = document.documentElement;
root.classList.add("js");
const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const first = (selector, within = document) => within.querySelector(selector);
const json = (element) => JSON.parse(element.textContent);

/* A new element: its text, its attributes. */
const make = (tag, text = "", attributes = {}) => {
  const element = document.createElement(tag);
  element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
};

/* The element that a link leads to: an anchor may be percent-encoded or not. */
const target = (hash) => {
  const anchor = hash.slice(1);
  if (!anchor) return null;
  try {
    return document.getElementById(anchor) ?? document.getElementById(decodeURIComponent(anchor));
  } catch {
    return null;
  }
};
