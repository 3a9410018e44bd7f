"""Pictures of reports: a page opened in chromium, with numbers where the text below explains it."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

REPOSITORY = Path(__file__).parents[2]
_SIZE = "1240,1500"  # pixels
_COLOURS = 256
_SETTLING = 2.0  # s until what comes near the window is drawn, too
_STOP = (
    "details.stop .tools",
    "details.stop dl.figures",
    "details.stop .changes",
    "details.stop table.margins tbody",
    "details.stop .panels-sketch, details.stop .panels-plot",
    "details.stop .readout",
)
"""What the numbers 1, 2, ... of the picture of a stop stand at, as the README's list explains them."""
_NUMBER = """
const [selector, number] = arguments;
const shown = [...document.querySelectorAll(selector)].find((each) => each.offsetParent && each.offsetHeight);
if (!shown) throw new Error(`nothing shown at ${selector}`);
const box = shown.getBoundingClientRect();
const mark = document.createElement("div");
mark.textContent = number;
mark.style.cssText = `position:absolute; left:${Math.max(4, box.left + scrollX - 34)}px;
  top:${box.top + scrollY}px; width:24px; height:24px; border-radius:50%; background:#b3261e; color:#fff;
  font:bold 15px/24px sans-serif; text-align:center`;
document.body.append(mark);
"""
_OPEN = "document.body.style.paddingLeft = '44px'; document.querySelector('details.stop').open = true"
_PLOTTED = "return document.querySelectorAll('.plots[data-ready] .panels-plot canvas').length > 0"


def draw_stop(picture: Path, folder: Path) -> None:
    """Draw the page of one stop, with a number at each of its parts."""
    page = _run(folder, "run", "scenarios/slip-120.yaml") / "latest" / "index.html"
    browser = _opened(page)
    try:
        browser.execute_script(_OPEN)
        _wait(browser, _PLOTTED)
        time.sleep(_SETTLING)
        browser.execute_script("document.querySelector('details.stop').scrollIntoView({behavior: 'instant'})")
        for number, selector in enumerate(_STOP, 1):
            browser.execute_script(_NUMBER, selector, str(number))
        browser.save_screenshot(str(picture))
        _in_few_colours(picture)
    finally:
        browser.quit()


def draw_map(picture: Path, folder: Path) -> None:
    """Draw the maps of the sweep over friction and command level."""
    sweep = "scenarios/slide-80-friction-command.sweep.yaml"
    page = next(_run(folder, "sweep", sweep).glob("*/index.html"))
    browser = _opened(page)
    try:
        browser.find_element("css selector", ".heat-maps").screenshot(str(picture))
        _in_few_colours(picture)
    finally:
        browser.quit()


def _run(folder: Path, command: str, file: str) -> Path:
    shutil.copytree(REPOSITORY / "scenarios", folder / "scenarios")
    reports = folder / "reports"
    subprocess.run(
        [sys.executable, "-m", "uictest", command, file, "-q", "-o", "reports"], cwd=folder, check=False
    )
    return reports


def _opened(page: Path) -> Any:
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = str(shutil.which("chromium"))
    for argument in ("--headless=new", "--no-sandbox", "--hide-scrollbars", f"--window-size={_SIZE}"):
        options.add_argument(argument)
    browser = webdriver.Chrome(options, webdriver.ChromeService(str(shutil.which("chromedriver"))))
    browser.get(page.as_uri())
    return browser


def _wait(browser: Any, condition: str) -> None:
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(browser, 60).until(lambda _: browser.execute_script(condition))


def _in_few_colours(picture: Path) -> None:
    from PIL import Image

    with Image.open(picture) as shot:
        shot.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)
