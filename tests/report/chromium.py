"""Chromium, headless, driven by selenium: what the tests of pages ask of it."""

import csv
import json
import os
import shutil
import time

import pytest

from uictest.report.page import page_html

ARGUMENTS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--no-first-run",
    "--force-prefers-reduced-motion",
    "--window-size=1400,1000",
)

PLOTTED = """
const plots = document.querySelector('details.stop[open] .plots');
if (plots && !plots.dataset.ready) {
  plots.scrollIntoView({block: 'nearest', behavior: 'instant'});
  return 0;
}
const panels = plots?.querySelector('.panels-plot').plots ?? [];
return panels.reduce((sum, {lines, bars}) => sum + lines.length + bars.length, 0);
"""
"""How many lines the plots of the open stop have, once they are drawn and answer, near the window."""

READY = "return document.querySelector('.plots[data-ready]') !== null"
"""Whether the plots of a stop, or of an overlay, answer."""

_LOADED = """
const [here, asked] = [document.URL, arguments[0]].map((url) => url === 'about:blank');
return document.readyState === 'complete' && here === asked;
"""

COMPARED = """
return document.querySelector('.compared-plot canvas') &&
  document.querySelectorAll('.cases li').length;
"""
"""How many cases are laid over each other, once they are drawn and the table beside them is filled."""


def started():
    """Return a browser; skip, or fail where UICTEST_BROWSER says that there must be one."""
    programs = {name: shutil.which(name) for name in ("chromium", "chromedriver")}
    for name, place in programs.items():
        if place is None:
            _unavailable(f"no {name} on the PATH (Debian: chromium, chromium-driver)")
    try:
        from selenium import webdriver
    except ModuleNotFoundError:
        _unavailable("selenium is not installed (it is in the extra 'dev')")
    options = webdriver.ChromeOptions()
    options.binary_location = str(programs["chromium"])
    for argument in ARGUMENTS:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.ChromeService(str(programs["chromedriver"]))

    class Chromium(webdriver.Chrome):
        def get(self, url):
            """Open a page, whole and with its scripts run: on a busy machine the driver returns before."""
            super().get(url)
            wait(self, _LOADED, url)

    return Chromium(options=options, service=service)


def _unavailable(reason):
    if os.environ.get("UICTEST_BROWSER") == "required":
        pytest.fail(reason)
    pytest.skip(reason)


def written(folder, page):
    """Write a page, or that of the content of a run; return where it stands."""
    path = folder / "index.html"
    path.write_text(page if isinstance(page, str) else page_html(page), encoding="utf-8")
    return path


def requests(browser):
    """Return what was asked for beyond the page itself and what it holds."""
    events = (json.loads(entry["message"])["message"] for entry in browser.get_log("performance"))
    urls = (e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent")
    return [url for url in urls if not url.startswith(("file:", "data:", "blob:", "about:"))]


def emulate(browser, scheme="light", media=""):
    """Prefer a colour scheme; show the page on a medium."""
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": media, "features": features})


def resize(browser, width):
    """Give the window a width in pixels; a narrow one is that of a phone."""
    metrics = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)


def run(browser, script, *arguments):
    """Return what a script returns."""
    return browser.execute_script(script, *arguments)


def texts(browser, selector):
    """Return the texts of all elements that a selector finds."""
    script = "return [...document.querySelectorAll(arguments[0])].map((each) => each.textContent.trim())"
    return run(browser, script, selector)


def by_head(browser, rows):
    """Return the texts of the cells of rows, by the text of the first."""
    script = """
      return Object.fromEntries([...document.querySelectorAll(arguments[0])]
        .map((row) => [...row.children].map((each) => each.textContent.trim()))
        .map(([head, ...cells]) => [head, cells]));
    """
    return run(browser, script, rows)


def click(browser, selector):
    """Click an element wherever it is: the page scrolls smoothly, and a pointer would come before its end."""
    run(browser, "document.querySelector(arguments[0]).click()", selector)


def choose(browser, name, value, within=".plots"):
    """Choose a value in one of the lists of the plots."""
    script = """
      const choice = document.querySelector(`${arguments[0]} select[data-choice=${arguments[1]}]`);
      choice.value = arguments[2];
      choice.dispatchEvent(new Event('change', {bubbles: true}));
    """
    run(browser, script, within, name, value)


def unfold(browser):
    """Open every fold of the page."""
    run(browser, "document.querySelectorAll('details').forEach((each) => { each.open = true; })")


def saved(browser, button):
    """Return what a button saves: the lines of comments, and the rows of the table."""
    script = """
      URL.createObjectURL = (blob) => { blob.text().then((text) => { window.saved = text; }); return '#'; };
      document.querySelector(arguments[0]).click();
    """
    run(browser, script, button)
    lines = wait(browser, "return window.saved").splitlines()
    comments = [line for line in lines if line.startswith("#")]
    return comments, list(csv.DictReader(lines[len(comments) :]))


def step_to(browser, slider, place):
    """Put a slider a step before a place, and press the arrow to it: a key for each step takes long."""
    run(browser, "[arguments[0].value] = [arguments[1]]", slider, place - 1)
    slider.send_keys("\ue014")


def wait(browser, script, *arguments):
    """Return what a script returns as soon as that is anything, at the latest after some minutes."""
    for _ in range(20_000):
        found = run(browser, script, *arguments)
        if found:
            return found
        time.sleep(0.01)
    raise AssertionError(f"nothing came of: {script}")
