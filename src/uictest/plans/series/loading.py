"""Read series files and validation files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import Field

from uictest.plans.scenario import (
    CAR,
    Case,
    Criteria,
    Files,
    NamedFile,
    Override,
    Parts,
    Roots,
    Variant,
    apply_overrides,
    case_id,
    controller_labels,
    expand,
    parse_overrides,
    sets_controller,
    short_keys,
    without_axis,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    SERIES_SCHEMA,
    VALIDATION_SCHEMA,
    Document,
    Inconsistency,
    List,
    Map,
    Model,
    Node,
    Quantity,
    Scalar,
    as_written,
    display_name,
    field,
    optional,
    plain,
    quantity,
    read_each,
    read_file,
    require_none,
    require_schema,
    validated,
)
from uictest.plans.series.model import DEFAULT_CRITERIA, Recorded, Series, SeriesFile
from uictest.plans.series.stops import (
    StopReader,
    cars_of,
    read_entry,
    read_stops,
    recorded_twice,
    require_few,
    values_set_by,
)

_NOT_A_SERIES: Final = {SCENARIO_SCHEMA: "give a scenario a file name that does not end in .series.yaml"}


def load_series(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> list[Series]:
    """Return the series of a file.

    Args:
        path: a ``*.series.yaml``.
        overrides: ``key=value`` texts for the scenarios of all stops. A comma list or
            ``range(first,last,step)`` makes a series of every value.
        seed: of the first stop of every case.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenarios that it names.

    """
    files = Files(Roots.of([path], trusted))
    tree = read_file(path, SERIES_SCHEMA)
    require_schema(tree, SERIES_SCHEMA, hints=_NOT_A_SERIES)
    of_command_line = parse_overrides(overrides, seed)
    profiles, documents = _resolved_profiles(tree, Parts(files))
    file: SeriesFile = validated(SeriesFile, {**plain(tree), "criteria": profiles}, tree)
    inputs = {each.display: each.sha256 for each in (tree.location.document, *documents) if each.sha256}
    common = [*values_set_by(tree, swept=False)]
    fixed = [each for each in of_command_line if len(each.values) == 1]
    variants = _variants_of_file(tree, of_command_line)
    require_few(tree, len(variants))
    settings = [setting for variant in variants for setting in variant]
    labels = controller_labels(settings, Parts(files))
    short = short_keys(list(dict.fromkeys(setting.key for setting in settings)))
    every: list[Series] = []
    for variant in variants:
        own = [Override(each.key, each.value.key, (each.value.node,)) for each in variant]
        judged, listed = file, read_stops(tree, file, files, common, [*own, *fixed])
        cases = [case for each in listed for case in each.read.cases]
        if sets_controller(each.key for each in (*own, *fixed)):
            judged = file.model_copy(update={"expect": file.expect.of_another_controller()})
        read = {shown: digest for case in cases for shown, digest in case.inputs.items()}
        parameters = {each.key: as_written(each.value.node) for each in variant}
        count = cars_of(listed)
        judged_cars = range(1, count + 1) if file.cars == "all" else (min(count, 1),)
        for car in judged_cars:  # from 1; 0 stands for a car alone
            name = case_id(file.name, variant, short, labels, car)
            of_all_cars = case_id(file.name, variant, short, labels)
            stops = StopReader(name, of_all_cars, file.criteria, car).stops(listed)
            of_car = {**parameters, CAR: str(car)} if car else parameters
            every.append(Series(name, Path(display_name(path)), judged, of_car, stops, {**inputs, **read}))
    return every


def _resolved_profiles(tree: Map, parts: Parts) -> tuple[tuple[Criteria, ...], tuple[Document, ...]]:
    entry = tree.entries.get("criteria")
    node: Node = Scalar(DEFAULT_CRITERIA, DEFAULT_CRITERIA, tree.location) if entry is None else entry.node
    nodes = node.items if isinstance(node, List) else (node,)
    profiles = [parts.part(node, Criteria, ("criteria",)) for node in nodes]
    documents = tuple(document for profile in profiles for document in profile.documents)
    return tuple(profile.part for profile in profiles), documents


def _variants_of_file(tree: Map, of_command_line: Sequence[Override]) -> list[Variant]:
    for each in of_command_line:
        if len(each.values) == 1:
            tree = without_axis(tree, each.key)
    varied = [each for each in of_command_line if len(each.values) > 1]
    return expand(apply_overrides(tree, varied))


class PlannedComparison(NamedTuple):
    """Recorded stops and the case that simulates them.

    Attributes:
        case: simulates each of the stops.
        recorded: the recorded stops.
        tuned: whether numbers of the case were found with these recordings.
    """

    case: Case
    recorded: Recorded
    tuned: bool = False


class ValidationPlan(NamedTuple):
    """One validation.

    Attributes:
        name: of the validation.
        title: one line for people.
        path: its file, as shown to users.
        comparisons: what is compared.
        speed_tolerance: largest difference of a recorded initial speed from its scenario's, m/s.
        confidence: of the intervals.
        inputs: every file read for it, by shown name, and its SHA-256; recordings are not among them.
    """

    name: str
    title: str
    path: Path
    comparisons: tuple[PlannedComparison, ...]
    speed_tolerance: float
    confidence: float
    inputs: Mapping[str, str]


class RecordedStops(Model):
    """Recorded stops that one scenario describes."""

    scenario: str = field("Relative path of the scenario.")
    recordings: tuple[str, ...] = field("Relative paths of the recorded stops.", min_length=1)
    map: str = field("Channel map of the recordings: a preset or a relative path.", default="uictest")
    set: dict[str, Any] = field("Values by dotted key of the scenario.", default={})
    repeat: Annotated[int, Field(ge=1, le=1000, strict=True)] | None = optional(
        "Seeds under which each stop is simulated; the medians are compared."
    )
    tuned: bool = field(
        "Whether numbers of the scenario were found with these recordings: they then show"
        " nothing, and are listed without being counted.",
        default=False,
        strict=True,
    )


class ValidationFile(NamedFile):
    """Recorded stops and the scenarios that simulate them."""

    schema_id: Literal["uictest/validation/1"] = field(
        "What the file holds: uictest/validation/1.", alias="schema"
    )
    stops: tuple[RecordedStops, ...] = field("The recorded stops.")
    speed_tolerance: Quantity = quantity(
        "Largest difference of a recorded initial speed from that of its scenario.",
        "speed",
        "0 km/h .. 50 km/h",
        default="3 km/h",
    )
    confidence: Quantity = quantity(
        "Confidence of the intervals.", "share", "50 % .. 99.99 %", default="95 %"
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an empty list of stops."""
        if not self.stops:
            yield Inconsistency(("stops",), "an empty list", "name at least one recorded stop")


def load_validation(
    path: Path, overrides: Sequence[str] = (), trusted: Sequence[Path] = ()
) -> ValidationPlan:
    """Return the validation of a file.

    Args:
        path: of the file.
        overrides: `key=value` texts for the scenarios of all stops.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenarios that it names.
    """
    files = Files(Roots.of([path], trusted))
    tree = read_file(path, VALIDATION_SCHEMA)
    require_schema(tree, VALIDATION_SCHEMA)
    file: ValidationFile = validated(ValidationFile, plain(tree), tree)
    comparisons = tuple(_planned_comparisons(tree, file, files, parse_overrides(overrides, None)))
    document = tree.location.document
    inputs = {document.display: document.sha256} if document.sha256 else {}
    for each in comparisons:
        inputs |= each.case.inputs
    limits = float(file.speed_tolerance), float(file.confidence)
    return ValidationPlan(file.name, file.title, Path(display_name(path)), comparisons, *limits, inputs)


def plan_of_series(planned: Series) -> ValidationPlan:
    """Return the validation by those stops of a series that name recordings."""
    comparisons = [
        PlannedComparison(stop.case, stop.recorded) for stop in planned.stops if stop.recorded is not None
    ]
    limits = float(planned.file.speed_tolerance), float(planned.file.confidence)
    return ValidationPlan(
        planned.id, planned.file.title, planned.path, tuple(comparisons), *limits, planned.inputs
    )


def _planned_comparisons(
    tree: Map, file: ValidationFile, files: Files, overrides: Sequence[Override]
) -> Iterator[PlannedComparison]:
    nodes = tree.get("stops")
    assert isinstance(nodes, List)
    read = read_each(lambda node: read_entry(node, "scenario", files, last=overrides), nodes.items)
    require_none(recorded_twice((stop.recorded, node) for stop, node in zip(read, nodes.items, strict=True)))
    for stop, stops in zip(read, file.stops, strict=True):
        (case,), recorded = stop.cases, stop.recorded
        assert recorded is not None
        yield PlannedComparison(replace(case, id=f"{file.name}.{case.id}"), recorded, stops.tuned)
