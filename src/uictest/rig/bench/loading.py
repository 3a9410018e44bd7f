"""Bench recipes: read, checked, and turned into a case and an input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import uictest
from uictest import identification, library
from uictest.recording import Recording
from uictest.rig.bench.inputs import (
    BenchInput,
    Clock,
    joined,
    random_pressure,
    recorded,
    stepwise,
    triangular,
    wsp_cycling,
)
from uictest.rig.bench.recipe import (
    BenchRecipe,
    FileReplay,
    Random,
    Rest,
    Stepwise,
    StopReplay,
    Triangular,
    WspCycling,
)
from uictest.rig.bench.run import clock_of, run_bench
from uictest.rig.simulation import simulate
from uictest.scenario import (
    PART_KEYS,
    SCENARIO_SCHEMA,
    Case,
    Files,
    Parts,
    Roots,
    resolve,
    with_default_parts,
)
from uictest.scenario.yaml import (
    Entry,
    Map,
    Scalar,
    apply_overrides,
    dotted,
    entry_at,
    parse_overrides,
    plain,
    read_file,
    single_error,
    validated,
    whole_file,
)

_FOLDER = Path(library.__file__).parent / "benches"
_SWEEPS = ("matrix", "zip", "include", "exclude")


@dataclass(frozen=True, slots=True)
class BenchTest:
    """A recipe, ready to run: ``case`` holds the rig, ``inputs`` every file that was read and its hash."""

    recipe: BenchRecipe
    case: Case
    folder: Path


def recipe_names() -> tuple[str, ...]:
    """Names of the recipes in the library, sorted."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.yaml")))


def recipe_path(reference: str) -> Path:
    """The file of a recipe: a path when it ends in .yaml or .yml, else the name of a library recipe."""
    return Path(reference) if reference.endswith((".yaml", ".yml")) else _FOLDER / f"{reference}.yaml"


def load_bench(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> BenchTest:
    """Read and check a recipe. ``overrides`` are ``key=value`` texts for its ``stop``.

    References stay at or below the recipe's folder, the working folder and the ``trusted`` folders.

    Raises ScenarioErrors with every error found.
    """
    tree = read_file(path)
    recipe: BenchRecipe = validated(BenchRecipe, plain(tree), tree)
    stop = _scenario_tree(tree, recipe, overrides, seed)
    files = Files(Roots.of([path], trusted))
    _refuse_traces_outside(tree, recipe, files)
    scenario, documents = resolve(stop, Parts(files))
    shown = f"library:benches/{path.name}" if path.parent == _FOLDER else tree.place.document.display
    inputs = {shown: tree.place.document.sha256}
    inputs |= {each.display: each.sha256 for each in documents if each.sha256}
    return BenchTest(recipe, Case(recipe.name, scenario, path, {}, inputs), path.parent)


def _refuse_traces_outside(tree: Map, recipe: BenchRecipe, files: Files) -> None:
    for number, given in enumerate(recipe.inputs):
        if isinstance(given, FileReplay):
            node = entry_at(tree, ("inputs", number, "file"))[0].node
            assert isinstance(node, Scalar)
            files.path_of(node, f"inputs.{number}.file")


def run_test(test: BenchTest) -> Recording:
    """Run a recipe; the recording tells which files it rests on, and the version of the program."""
    recording = run_bench(test.case, bench_input(test))
    facts = {
        **recording.metadata,
        "version": uictest.__version__,
        **{f"sha256 of {name}": value for name, value in test.case.inputs.items()},
    }
    return Recording(recording.channels, recording.units, facts)


def bench_input(test: BenchTest) -> BenchInput:
    """Demand and commands of a recipe, its recorded stops simulated. Raises as reading a recording does."""
    clock = clock_of(test.case)
    return joined(_made(each, test, clock) for each in test.recipe.inputs)


def _scenario_tree(tree: Map, recipe: BenchRecipe, overrides: Sequence[str], seed: int | None) -> Map:
    """The recipe's ``stop`` as the tree of a whole scenario."""
    found = tree.get("stop")
    stop = found if isinstance(found, Map) else Map({}, tree.place)
    for key in ("schema", "name", "extends", *_SWEEPS):
        if (entry := stop.entries.get(key)) is not None:
            raise single_error(
                entry.key, f"key '{key}' does not belong here", f"stop.{key}", f"leave out {key}"
            )
    texts = {"schema": SCENARIO_SCHEMA, "name": recipe.name, "initial_speed": "80 km/h"}
    given = {key: Entry(stop.place, Scalar(text, text, stop.place)) for key, text in texts.items()}
    whole = with_default_parts(replace(stop, entries={**given, **stop.entries}))
    changed = apply_overrides(whole, parse_overrides(overrides, seed), frozenset(map(dotted, PART_KEYS)))
    for key in _SWEEPS:
        if (entry := changed.entries.get(key)) is not None:
            raise single_error(
                entry.node.place, "a bench test is one run: give one value", hint="no lists here"
            )
    return changed


def _made(given: Any, test: BenchTest, clock: Clock) -> BenchInput:
    match given:
        case Rest():
            return stepwise([0.0], given.duration, clock)
        case Stepwise():
            return stepwise(given.levels, given.hold, clock)
        case Triangular():
            return triangular(given.peaks, given.floor, 1e5 / given.ramp, clock)
        case Random():
            return random_pressure(
                given.lowest, given.highest, given.interval, given.duration, given.seed, clock
            )
        case WspCycling():
            return wsp_cycling(
                given.pressure,
                given.lead,
                given.cycles,
                given.vent,
                given.hold,
                given.fill,
                given.seed,
                clock,
            )
        case StopReplay():
            return _recorded_stop(given, test.case, clock)
        case FileReplay():
            return _traced(given, test.folder, clock)
    raise AssertionError(f"an input of an unknown kind: {given!r}")


def _recorded_stop(given: StopReplay, case: Case, clock: Clock) -> BenchInput:
    rail = case.scenario.rail.model_copy(update={"friction": given.friction})
    scenario = case.scenario.model_copy(update={"rail": rail, "seed": given.seed})
    recording = simulate(replace(case, scenario=scenario), clock.cycle_time).recording
    assert recording is not None
    commands = recording[f"valve_command_{given.wheelset}"]
    return recorded(recording["time"], recording["demanded_pressure"], commands, clock)


def _traced(given: FileReplay, folder: Path, clock: Clock) -> BenchInput:
    wanted = {"pressure": given.pressure}
    if given.command is not None:
        wanted["command"] = given.command
    channels = identification.read_record(folder / given.file, wanted).channels
    return recorded(channels["time"], channels["pressure"], channels.get("command"), clock)


def trace_recipe(
    file: Path,
    pressure: str,
    command: str | None,
    overrides: Sequence[str] = (),
    seed: int | None = None,
    trusted: Sequence[Path] = (),
) -> BenchTest:
    """A recipe made of one recording, on the library's rig. Raises ScenarioErrors for wrong overrides."""
    place = whole_file(file)
    recipe = BenchRecipe(
        schema="uictest/bench/1",
        name="trace",
        inputs=(FileReplay(kind="trace", file=file.name, pressure=pressure, command=command),),
    )
    tree = _scenario_tree(Map({}, place), recipe, overrides, seed)
    scenario, documents = resolve(tree, Parts(Files(Roots.of([file], trusted))))
    inputs = {each.display: each.sha256 for each in documents if each.sha256}
    return BenchTest(recipe, Case("trace", scenario, file, {}, inputs), file.parent)
