"""Pages of runs in a browser: how large they are, how fast they are written, opened, filtered and scrolled.

`python benchmarks/pages.py [--cases 17,1000,5000] [--turns 5] [--against CHECKOUT]`

Chromium and its driver must be on the PATH, selenium in the environment. `--against` takes the checkout of
another version: both write the page of the same run and are timed in turns. Times are in ms and medians over
the turns, each in a browser of its own; `processor` is the processor time of the page's main thread, on which
other load has little effect.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from html import unescape
from pathlib import Path
from statistics import median
from typing import Any
from urllib.parse import quote

import machine
from page_runs import run_folder, stops_in

HERE = Path(__file__).resolve().parent.parent
WRITER = """\
import sys, time
from pathlib import Path
from uictest import report
from uictest.report import page
content = report.read_run(Path(sys.argv[1]), traces=True)
page.page_html(content)
begin = time.perf_counter()
text = page.page_html(content).encode()
Path(sys.argv[2]).write_bytes(text)
print(time.perf_counter() - begin)
"""
ARGUMENTS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--no-first-run",
    "--window-size=1400,1000",
)
OBSERVER = """
window.seen = {tasks: []};
new PerformanceObserver((list) => seen.tasks.push(...list.getEntries().map((each) => each.duration)))
  .observe({type: "longtask", buffered: true});
const look = () => {
  const now = (name) => setTimeout(() => { seen[name] ??= performance.now(); });
  const drawing = document.querySelector("details.stop[open] svg.panels");
  const { top, height } = drawing?.getBoundingClientRect() ?? {};
  if (height && top < innerHeight) now("drawing");
  if (document.querySelector(".panels-plot :is(canvas, .scatterlayer .trace path)")) return now("plot");
  requestAnimationFrame(look);
};
requestAnimationFrame(look);
"""
"""What is in a frame counts as shown at the end of it."""
TIMED = """
const done = arguments[arguments.length - 1];
const act = new Function(arguments[0]);
const begin = performance.now();
act();
setTimeout(() => requestAnimationFrame(() => setTimeout(() => done(performance.now() - begin))));
"""
"""Until the frame that shows what was done has been painted."""
SCROLLED = """
const done = arguments[arguments.length - 1];
const frames = [];
const from = document.querySelector("table.verdicts").getBoundingClientRect().top + scrollY;
let last = performance.now();
const next = (now) => {
  frames.push(now - last);
  last = now;
  if (frames.length > 150) return done(Math.max(...frames.slice(2)));
  scrollTo({top: from + frames.length * 400, behavior: "instant"});
  requestAnimationFrame(next);
};
requestAnimationFrame(next);
"""
ACTIONS = {
    "search": """
const search = document.querySelector('input[name=text]');
search.value = 'slide-80 copy=00';
search.dispatchEvent(new Event('input', {bubbles: true}));
""",
    "clear": "document.querySelector('form.filters button[type=reset]').click()",
    "verdict off": "document.querySelector('input[name=word]').click()",
    "verdict on": "document.querySelector('input[name=word]').click()",
    "sort by number": "document.querySelectorAll('table.verdicts thead button')[3].click()",
    "sort by case": "document.querySelectorAll('table.verdicts thead button')[2].click()",
}


def write_page(source: Path, run: Path, page: Path) -> float:
    """Let a checkout write the page of a run; return how long it took, in s, without reading the run."""
    environment = os.environ | {"PYTHONPATH": str(source / "src")}
    words = [sys.executable, "-c", WRITER, str(run), str(page)]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    return float(done.stdout)


def browser() -> Any:
    """Return a browser, headless, that notes its long tasks and when the first plot is there."""
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = str(shutil.which("chromium"))
    for argument in ARGUMENTS:
        options.add_argument(argument)
    driver = webdriver.Chrome(
        options=options, service=webdriver.ChromeService(str(shutil.which("chromedriver")))
    )
    driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": OBSERVER})
    driver.set_script_timeout(120)
    time.sleep(2.0)  # A browser that has just started is busy with itself.
    return driver


def opened(driver: Any, page: Path) -> dict[str, float]:
    """Open a page at the stop that is unfolded; return when a drawing and a plot were to be seen, in ms."""
    driver.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
    anchor = re.search(r'id="(case-[^"]+)" open>', page.read_text("utf-8"))
    driver.get(f"{page.as_uri()}#{quote(unescape(anchor[1])) if anchor else ''}")
    for _ in range(1200):
        if driver.execute_script("return seen.plot ?? 0"):
            break
        time.sleep(0.1)
    time.sleep(1.0)
    first_paint = "return performance.getEntriesByName('first-contentful-paint')[0].startTime"
    return {
        "first paint": driver.execute_script(first_paint),
        "first drawing": driver.execute_script("return seen.drawing ?? NaN"),
        "first plot": driver.execute_script("return seen.plot ?? NaN"),
        "opening, processor": processor_time(driver),
    }


def used(driver: Any) -> dict[str, float]:
    """Filter, sort and scroll the page that is open; return how long each took, in ms."""
    times = {}
    for name, script in ACTIONS.items():
        before = processor_time(driver)
        times[name] = driver.execute_async_script(TIMED, script)
        times[f"{name}, processor"] = processor_time(driver) - before
        time.sleep(0.3)
    driver.execute_script("seen.tasks.length = 0")
    times["scroll, worst frame"] = driver.execute_async_script(SCROLLED)
    time.sleep(0.3)
    return times | {"scroll, longest task": driver.execute_script("return Math.max(0, ...seen.tasks)")}


def processor_time(driver: Any) -> float:
    """Return the processor time that the page's main thread has spent on tasks, ms."""
    metrics = driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return 1e3 * next(float(each["value"]) for each in metrics if each["name"] == "TaskDuration")


def turn(page: Path) -> dict[str, float]:
    """Return the times of one page in a browser of its own."""
    with ExitStack() as stack:
        driver = browser()
        stack.callback(driver.quit)
        return opened(driver, page) | used(driver)


def measure(candidates: dict[str, Path], run: Path, cases: int, turns: int) -> None:
    """Print what the page of a run takes with each candidate."""
    pages, found = {}, {}
    for name, source in candidates.items():
        pages[name] = run / f"{name}.html"
        took = write_page(source, run, pages[name])
        found[name] = {"size, MB": pages[name].stat().st_size / 1e6, "written, s": took}
    times: dict[str, list[dict[str, float]]] = {name: [] for name in candidates}
    for _ in range(turns):
        for name in candidates:
            times[name].append(turn(pages[name]))
    for name, own in times.items():
        for key in own[0]:
            found[name][key] = median(each[key] for each in own)
    print(f"\n{cases} cases".ljust(36) + "".join(f"{name:>12}" for name in candidates))
    for key in next(iter(found.values())):
        form = ".2f" if key.startswith(("size", "written")) else ".0f"
        print(f"{key:35}" + "".join(f"{each[key]:12{form}}" for each in found.values()), flush=True)


def main() -> None:
    """Print a table for each number of cases."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", default="17,1000,5000")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--against", type=Path, metavar="CHECKOUT")
    arguments = parser.parse_args()
    candidates = {"this": HERE} | ({"other": arguments.against} if arguments.against else {})
    load = os.getloadavg()[0]
    print(machine.description("youplot", "selenium"), f"; load average {load:.1f}", sep="", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        sources = stops_in(Path(folder))
        for cases in map(int, arguments.cases.split(",")):
            measure(candidates, run_folder(Path(folder) / str(cases), sources, cases), cases, arguments.turns)


if __name__ == "__main__":
    main()
