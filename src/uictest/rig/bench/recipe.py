"""Bench recipes: the rig they are for and the inputs that are applied, read and checked."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from uictest.plans import library
from uictest.plans.scenario import (
    EXPANSION_KEYS,
    Case,
    Files,
    Parts,
    Roots,
    Scenario,
    apply_overrides,
    parse_overrides,
    resolve,
    with_default_parts,
)
from uictest.plans.scenario.yaml import (
    BENCH_SCHEMA,
    SCENARIO_SCHEMA,
    Entry,
    Map,
    Part,
    Quantity,
    Scalar,
    Section,
    dotted,
    entry_at,
    of_kind,
    plain,
    read_file,
    require_schema,
    single_error,
    suggestion,
    validated,
    whole_file,
)

Pressure = Annotated[Quantity, of_kind("pressure", "0 bar .. 12 bar")]
Duration = Annotated[Quantity, of_kind("time", "> 0 s .. 600 s")]
Seed = Annotated[int, Field(ge=0, le=2**32 - 1, strict=True)]
Span = tuple[Duration, Duration]


class Rest(Section):
    """No pressure demanded, the valves fill: the brake is released."""

    kind: Literal["rest"]
    duration: Duration = Field(description="How long.")


class Stepwise(Section):
    """Pressure levels demanded one after the other, WSP bypassed."""

    kind: Literal["stepwise"]
    levels: tuple[Pressure, ...] = Field(min_length=1, max_length=1000, description="Gauge pressures.")
    hold: Duration = Field(description="Time at each level.")


class Triangular(Section):
    """Ramps up to each peak and down again, WSP bypassed."""

    kind: Literal["triangular"]
    peaks: tuple[Pressure, ...] = Field(min_length=1, max_length=1000, description="Gauge pressures.")
    floor: Pressure = Field(description="Gauge pressure between two peaks.")
    ramp: Duration = Field(description="Time for one bar.")


class Random(Section):
    """Straight lines between random pressures, WSP bypassed."""

    kind: Literal["random"]
    lowest: Pressure = Field(description="Least gauge pressure that is drawn.")
    highest: Pressure = Field(description="Largest gauge pressure that is drawn.")
    interval: Duration = Field(description="Time between two drawn pressures.")
    duration: Duration = Field(description="How long.")
    seed: Seed = Field(description="Seed of the draw.")


class WspCycling(Section):
    """A full application, then vent, hold and fill in turn for random times."""

    kind: Literal["wsp"]
    pressure: Pressure = Field(description="Gauge pressure demanded of the brake line.")
    lead: Duration = Field(description="Time of filling before the first vent.")
    cycles: int = Field(ge=1, le=10_000, strict=True, description="Number of vents.")
    vent: Span = Field(description="Shortest and longest vent.")
    hold: Span = Field(description="Shortest and longest hold.")
    fill: Span = Field(description="Shortest and longest fill.")
    seed: Seed = Field(description="Seed of the draw.")


class StopReplay(Section):
    """Demand and valve commands of one wheelset in the recipe's stop, simulated on its rig."""

    kind: Literal["stop"]
    friction: Annotated[Quantity, of_kind("number", "0.001 .. 1")] = Field(
        description="Initial friction coefficient of the rail."
    )
    position: str | None = Field(default=None, description="Brake position; none: that of the recipe's stop.")
    wheelset: int = Field(ge=1, le=4, strict=True, description="Wheelset whose commands are taken.")
    seed: Seed = Field(description="Seed of the sensors' noise in that stop.")


class FileReplay(Section):
    """Demand, and commands if there are any, from a recording."""

    kind: Literal["trace"]
    file: str = Field(description="Recording; a path relative to the recipe.")
    pressure: str = Field(default="demanded_pressure", description="Channel of the demanded gauge pressure.")
    command: str | None = Field(default=None, description="Channel of the valve command; none: always fill.")


Input = Annotated[
    Rest | Stepwise | Triangular | Random | WspCycling | StopReplay | FileReplay, Field(discriminator="kind")
]


class BenchRecipe(Part):
    """A bench test of the caliper, without vehicle and controller."""

    folder: ClassVar[str] = "benches"

    schema_id: Literal["uictest/bench/1"] = Field(
        alias="schema", description="What the file holds and in which version: uictest/bench/1."
    )
    stop: dict[str, Any] = Field(
        default_factory=dict,
        description="A scenario without schema and name: its rig, brake and seed are used.",
    )
    inputs: tuple[Input, ...] = Field(min_length=1, max_length=1000, description="One after the other.")


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
    tree = read_file(path, BENCH_SCHEMA)
    require_schema(tree, BENCH_SCHEMA)
    recipe: BenchRecipe = validated(BenchRecipe, plain(tree), tree)
    stop = _scenario_tree(tree, recipe, overrides, seed)
    files = Files(Roots.of([path], trusted))
    _reject_traces_outside(tree, recipe, files)
    scenario, documents = resolve(stop, Parts(files))
    _reject_unknown_positions(tree, recipe, scenario)
    shown = f"library:benches/{path.name}" if path.parent == _FOLDER else tree.location.document.display
    inputs = {shown: tree.location.document.sha256}
    inputs |= {document.display: document.sha256 for document in documents if document.sha256}
    return BenchTest(recipe, Case(recipe.name, scenario, path, {}, inputs), path.parent)


def _reject_traces_outside(tree: Map, recipe: BenchRecipe, files: Files) -> None:
    for number, segment in enumerate(recipe.inputs):
        if isinstance(segment, FileReplay):
            node = entry_at(tree, ("inputs", number, "file"))[0].node
            assert isinstance(node, Scalar)
            files.path_of(node, f"inputs.{number}.file")


def _reject_unknown_positions(tree: Map, recipe: BenchRecipe, scenario: Scenario) -> None:
    positions = tuple(scenario.brake.system.positions)
    for number, segment in enumerate(recipe.inputs):
        if isinstance(segment, StopReplay) and segment.position not in (None, *positions):
            key = ("inputs", number, "position")
            raise single_error(
                entry_at(tree, key)[0].node.location,
                f"unknown brake position {segment.position!r}",
                dotted(key),
                suggestion(str(segment.position), positions),
            )


def _scenario_tree(tree: Map, recipe: BenchRecipe, overrides: Sequence[str], seed: int | None) -> Map:
    section = tree.get("stop")
    stop = section if isinstance(section, Map) else Map({}, tree.location)
    for key in ("schema", "name", "extends", *EXPANSION_KEYS):
        if (entry := stop.entries.get(key)) is not None:
            raise single_error(
                entry.key, f"key '{key}' does not belong here", f"stop.{key}", f"leave out {key}"
            )
    texts = {"schema": SCENARIO_SCHEMA, "name": recipe.name, "initial_speed": "80 km/h"}
    required = {key: Entry(stop.location, Scalar(text, text, stop.location)) for key, text in texts.items()}
    whole = with_default_parts(stop._replace(entries={**required, **stop.entries}))
    changed = apply_overrides(whole, parse_overrides(overrides, seed))
    for key in EXPANSION_KEYS:
        if (entry := changed.entries.get(key)) is not None:
            raise single_error(
                entry.node.location, "a bench test is one run: give one value", hint="no lists here"
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
        schema=BENCH_SCHEMA,
        name="trace",
        inputs=(FileReplay(kind="trace", file=file.name, pressure=pressure, command=command),),
    )
    tree = _scenario_tree(Map({}, place), recipe, overrides, seed)
    scenario, documents = resolve(tree, Parts(Files(Roots.of([file], trusted))))
    inputs = {document.display: document.sha256 for document in documents if document.sha256}
    return BenchTest(recipe, Case("trace", scenario, file, {}, inputs), file.parent)
