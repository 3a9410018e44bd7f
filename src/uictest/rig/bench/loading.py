"""Read and check bench recipes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from uictest.plans import library
from uictest.plans.scenario import (
    EXPANSION_KEYS,
    PART_KEYS,
    SCENARIO_SCHEMA,
    Case,
    Files,
    Parts,
    Roots,
    Scenario,
    resolve,
    with_default_parts,
)
from uictest.plans.scenario.yaml import (
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
    suggestion,
    validated,
    whole_file,
)
from uictest.rig.bench.recipe import BenchRecipe, FileReplay, StopReplay

_FOLDER = Path(library.__file__).parent / "benches"


@dataclass(frozen=True, slots=True)
class BenchTest:
    """A recipe, ready to run: `case` holds the rig, `folder` is where its recordings are."""

    recipe: BenchRecipe
    case: Case
    folder: Path


def recipe_names() -> tuple[str, ...]:
    """Return the names of the recipes in the library, sorted."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.yaml")))


def recipe_path(reference: str) -> Path:
    """Return the file of a recipe, given as a path (.yaml, .yml) or as the name of a library recipe."""
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
    _reject_traces_outside(tree, recipe, files)
    scenario, documents = resolve(stop, Parts(files))
    _reject_unknown_positions(tree, recipe, scenario)
    shown = f"library:benches/{path.name}" if path.parent == _FOLDER else tree.place.document.display
    inputs = {shown: tree.place.document.sha256}
    inputs |= {document.display: document.sha256 for document in documents if document.sha256}
    return BenchTest(recipe, Case(recipe.name, scenario, path, {}, inputs), path.parent)


def _reject_traces_outside(tree: Map, recipe: BenchRecipe, files: Files) -> None:
    """Raise ScenarioErrors for a recording outside the folders that may be read."""
    for number, segment in enumerate(recipe.inputs):
        if isinstance(segment, FileReplay):
            node = entry_at(tree, ("inputs", number, "file"))[0].node
            assert isinstance(node, Scalar)
            files.path_of(node, f"inputs.{number}.file")


def _reject_unknown_positions(tree: Map, recipe: BenchRecipe, scenario: Scenario) -> None:
    """Raise ScenarioErrors for a brake position that the brake system does not have."""
    positions = tuple(scenario.brake.system.positions)
    for number, segment in enumerate(recipe.inputs):
        if isinstance(segment, StopReplay) and segment.position not in (None, *positions):
            key = ("inputs", number, "position")
            raise single_error(
                entry_at(tree, key)[0].node.place,
                f"unknown brake position {segment.position!r}",
                dotted(key),
                suggestion(str(segment.position), positions),
            )


def _scenario_tree(tree: Map, recipe: BenchRecipe, overrides: Sequence[str], seed: int | None) -> Map:
    """Return the recipe's ``stop`` as the tree of a whole scenario."""
    section = tree.get("stop")
    stop = section if isinstance(section, Map) else Map({}, tree.place)
    for key in ("schema", "name", "extends", *EXPANSION_KEYS):
        if (entry := stop.entries.get(key)) is not None:
            raise single_error(
                entry.key, f"key '{key}' does not belong here", f"stop.{key}", f"leave out {key}"
            )
    texts = {"schema": SCENARIO_SCHEMA, "name": recipe.name, "initial_speed": "80 km/h"}
    required = {key: Entry(stop.place, Scalar(text, text, stop.place)) for key, text in texts.items()}
    whole = with_default_parts(replace(stop, entries={**required, **stop.entries}))
    changed = apply_overrides(whole, parse_overrides(overrides, seed), frozenset(map(dotted, PART_KEYS)))
    for key in EXPANSION_KEYS:
        if (entry := changed.entries.get(key)) is not None:
            raise single_error(
                entry.node.place, "a bench test is one run: give one value", hint="no lists here"
            )
    return changed


def trace_recipe(
    file: Path,
    pressure: str,
    command: str | None,
    overrides: Sequence[str] = (),
    seed: int | None = None,
    trusted: Sequence[Path] = (),
) -> BenchTest:
    """Return a recipe of one recording on the library's rig. Raises ScenarioErrors for wrong overrides."""
    place = whole_file(file)
    recipe = BenchRecipe(
        schema="uictest/bench/1",
        name="trace",
        inputs=(FileReplay(kind="trace", file=file.name, pressure=pressure, command=command),),
    )
    tree = _scenario_tree(Map({}, place), recipe, overrides, seed)
    scenario, documents = resolve(tree, Parts(Files(Roots.of([file], trusted))))
    inputs = {document.display: document.sha256 for document in documents if document.sha256}
    return BenchTest(recipe, Case("trace", scenario, file, {}, inputs), file.parent)
