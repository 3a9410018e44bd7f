"""How many planted weaknesses a search finds: guided and random side by side.

    python benchmarks/search.py [--stops 500,2000] [--seed 1] [--only NAME] [SCENARIO ...]

Each controller is that of examples/threshold-c with one planted weakness; a C compiler is needed. SCENARIO is
another scenario whose controller has one. All are searched in one space. `found after` counts all stops,
those that confirm included; `off nominal` the values of the case that was made small, a fault being one.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import tempfile
from pathlib import Path
from time import perf_counter

import yaml

from uictest import runs, searching
from uictest.controllers import HEADER
from uictest.plans.search import load_search

TRUSTED = [Path.cwd(), Path(tempfile.gettempdir())]
C_FILE = Path(__file__).parent.parent / "examples/threshold-c/threshold.c"
SEARCHED = {
    "criteria": ["locked-wheels"],
    "ranges": {
        "rail.friction": [0.06, 0.20],
        "initial_speed": ["90 km/h", "160 km/h"],
        "vehicle.load": ["0 t", "8 t"],
        "brake.command": ["80 %", "100 %"],
    },
    "fails_in": "8 of 10",
}
BASE = {
    "schema": "uictest/scenario/1",
    "initial_speed": "120 km/h",
    "vehicle": {"extends": "intercity-180", "payload": "8 t", "load": "4 t"},
    "brake": {
        "command": "100 %",
        "position": "R",
        "system": {"extends": "ep-disc", "load_valve": {"empty_share": "84 %"}},
    },
    "rail": {"condition": "wet", "friction": 0.09},
    "criteria": ["uictest-stop"],
}
RELEASE = "outputs->hold[{i}] = outputs->vent[{i}] = 0;"
"""The magnets of a wheelset are off: it fills, whatever it does."""
ALL = "for (int k = 0; k < WHEELSETS; k++) " + RELEASE.format(i="k")
WEAKNESSES = {
    "sound": "",
    "wheelset 2, loaded, at 105 km/h": "if (inputs->cylinder_pressure[1] > 3.5e5 && c->reference_speed > 28.0"
    " && c->reference_speed < 31.0) " + RELEASE.format(i=1),
    "a timer after 80 s": "if (inputs->time > 80.0) " + ALL,
    "wheelset 4 late, below 35 km/h": "if (inputs->time > 60.0 && c->reference_speed < 9.7"
    " && inputs->wheel_speed[3] > 0.3 * c->reference_speed) " + RELEASE.format(i=3),
    "pressure above 3.7 bar": "if (inputs->cylinder_pressure[0] > 3.7e5) " + RELEASE.format(i=0),
    "stops from 131.0 to 131.8 km/h": "if (c->initial_speed > 36.39 && c->initial_speed < 36.61"
    " && c->reference_speed < 20.0 && c->reference_speed > 15.0) " + ALL,
}
"""Name -> statements at the end of each step."""
_PLACE = "    outputs->reference_speed = c->reference_speed;"


def write_weak_controller(folder: Path, statements: str) -> dict[str, object]:
    """Compile the controller with a weakness, and return its section of a scenario."""
    source = C_FILE.read_text("utf-8").replace(_PLACE, f"    {statements}\n{_PLACE}")
    (folder / "wsp.c").write_text(source, "utf-8")
    options = ("-O2", "-ffp-contract=off", "-fPIC", "-shared", f"-I{HEADER.parent}", "-o", "libwsp.so")
    subprocess.run([os.environ.get("CC", "gcc"), *options, "wsp.c", "-lm"], check=True, cwd=folder)
    section: dict[str, object] = yaml.safe_load(C_FILE.with_suffix(".yaml").read_text("utf-8"))["controller"]
    return section


def searched(
    path: Path, stops: int, seed: int = 1, jobs: int = 1, *, guided: bool = True
) -> searching.SearchOutcome:
    """Search a scenario in memory; on several threads, controllers run in child processes."""
    space = load_search(path, (), seed, (*TRUSTED, path.parent), stops)
    request = searching.SearchRequest(space, None, jobs, guided=guided, in_process=jobs == 1)
    return searching.run_search(request, lambda stops, margin: None, runs.Observer())


def show_row(name: str, path: Path, stops: int, seed: int, jobs: int, *, guided: bool) -> None:
    """Search once and print a row."""
    started = perf_counter()
    outcome = searched(path, stops, seed, jobs, guided=guided)
    seconds = perf_counter() - started
    after = outcome.findings.found_after.get("locked-wheels")
    margin = outcome.findings.margins["locked-wheels"]
    found = f"found after {after:5}" if after else f"smallest margin {margin:.2f}"
    off_nominal = min((case.off_nominal for case in outcome.found), default=None)
    rate = 1000.0 * seconds / (outcome.stops + outcome.stops_of_shrinking)
    kind = "guided" if guided else "random"
    print(f"{name:32} {stops:5} {kind}  {found:20}  off nominal {off_nominal}  {rate:.1f} s/1000", flush=True)
    for case in outcome.found[:1]:
        print(f"    {case.sentence}", flush=True)


def write_weak_scenario(folder: Path, name: str) -> Path:
    """Write the scenario of a controller with one of the weaknesses, and return its path."""
    folder.mkdir()
    section = write_weak_controller(folder, WEAKNESSES[name])
    scenario = {**BASE, "name": f"weak-{folder.name}", "controller": section, "search": SEARCHED}
    path = folder / "weak.yaml"
    path.write_text(yaml.safe_dump(scenario, sort_keys=False), "utf-8")
    return path


def main() -> None:
    """Print a row for each controller, number of stops and way of searching."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--stops", default="500,2000")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--kinds", default="guided,random")
    parser.add_argument("scenarios", nargs="*", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        paths: dict[str, Path] = {}
        for number, name in enumerate(WEAKNESSES if not options.scenarios else ()):
            paths[name] = write_weak_scenario(Path(place) / str(number), name)
        for number, path in enumerate(options.scenarios):
            paths[path.stem] = Path(place) / f"{number}.yaml"
            extended = {"schema": "uictest/scenario/1", "name": f"other-{number}", "search": SEARCHED}
            extended["extends"] = os.path.relpath(path, place)
            paths[path.stem].write_text(yaml.safe_dump(extended, sort_keys=False), "utf-8")
        for name, path in paths.items():
            for stops in map(int, options.stops.split(",")):
                for kind in options.kinds.split(","):
                    if options.only in name:
                        show_row(name, path, stops, options.seed, options.jobs, guided=kind == "guided")


if __name__ == "__main__":
    main()
