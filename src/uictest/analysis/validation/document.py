"""A validation: recorded stops and their simulations, the agreement of figures, and its JSON document."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import ClassVar, Final

from pydantic import ConfigDict, TypeAdapter

from uictest import __version__
from uictest.analysis.validation.domain import Conditions, Domain, conditions_of, deviations, domains_of
from uictest.core import envelope
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, column_unit
from uictest.core.statistics import mean_interval, next_interval
from uictest.judging.evaluation import (
    CaseResult,
    DomainOfValidity,
    EffectivePart,
    Number,
    from_json_form,
    to_json_form,
)
from uictest.plans.scenario import Case
from uictest.plans.scenario.yaml import display_name, parse_quantity
from uictest.plans.series import ValidationPlan

Figures = Mapping[str, Number]
"""Column of results, of a wheelset `maximum_slide_1` -> number; NaN where it is not known."""


@dataclass(frozen=True, slots=True)
class ComparedStop:
    """One recorded stop and its simulation.

    Attributes:
        id: id of the recorded stop and of its simulation.
        recording: file, as shown to users.
        sha256: SHA-256 of the file.
        initial_speed: recorded, m/s; the simulation has the same.
        recorded: its figures.
        simulated: the same figures of the simulation; medians where it was repeated.
        repeats: seeds under which it was simulated.
        seed: the first of them; None in documents that do not name it.
        tuned: whether numbers of the scenario were found with it: it then shows nothing of the model.
        not_counted: why it cannot be compared; empty where it can.
    """

    id: str
    recording: str
    sha256: str
    initial_speed: float
    recorded: Figures = field(default_factory=dict)
    simulated: Figures = field(default_factory=dict)
    repeats: int = 1
    seed: int | None = None
    tuned: bool = False
    not_counted: str = ""

    @property
    def counted(self) -> bool:
        """Whether it takes part in bias, spread and domain."""
        return not (self.tuned or self.not_counted)


def as_recorded(case: Case, case_id: str, initial_speed: float, digest: str) -> Case:
    """Return the case of a recorded stop, simulated from its own initial speed, m/s, under its own seed.

    `digest` is the SHA-256 of the recording as hexadecimal digits.
    """
    speed = parse_quantity(f"{initial_speed!r} m/s", "speed")
    changes = {"initial_speed": speed, "seed": seed_of(case.scenario.seed, digest)}
    return replace(case, id=case_id, scenario=case.scenario.model_copy(update=changes))


def seed_of(scenario_seed: int, digest: str) -> int:
    """Return the seed of a recorded stop: the first 31 bits of the SHA-256 of the text `SEED DIGEST`.

    Stops that share a draw would have differences that are no independent draws, and intervals that are too
    narrow. The seed depends on nothing else, so that further stops or another order change none.
    """
    words = hashlib.sha256(f"{scenario_seed} {digest}".encode()).digest()
    return int.from_bytes(words[:4], "big") >> 1


def figures_of(result: CaseResult) -> dict[str, float]:
    """Return the figures of a stop and of its wheelsets."""
    figures = dict(result.measures or {})
    for number, columns in enumerate(result.wheelsets, start=1):
        figures |= {f"{name}_{number}": value for name, value in columns.items()}
    return figures


def relative_difference(recorded: Figures, simulated: Figures) -> float:
    """Return by what share of the recorded braking distance the simulated one is longer; NaN without both."""
    ours, theirs = (figures.get("braking_distance_m", math.nan) for figures in (recorded, simulated))
    return (theirs - ours) / ours if ours else math.nan


@dataclass(frozen=True, slots=True)
class Differences:
    """Differences summed up; NaN is what one stop, or equal differences, cannot show.

    Attributes:
        bias: their mean.
        deviation: their standard deviation.
        bias_low, bias_high: interval of the mean of all such stops.
        limits_low, limits_high: limits of agreement, in which the difference of a further stop lies.
    """

    bias: Number
    deviation: Number
    bias_low: Number
    bias_high: Number
    limits_low: Number
    limits_high: Number


@dataclass(frozen=True, slots=True)
class Agreement:
    """How a simulated figure agrees with the recorded one.

    Attributes:
        figure: a column of results; of a wheelset `maximum_slide_1`.
        unit: unit of the figure.
        stops: in which both are known.
        recorded_mean: mean of the recorded figures.
        absolute: the differences, in `unit`.
        relative: the same as shares of the recorded figures; None where one of these is not positive.
    """

    figure: str
    unit: str
    stops: int
    recorded_mean: Number
    absolute: Differences
    relative: Differences | None


def agreement_of(
    figure: str, unit: str, recorded: Sequence[float], simulated: Sequence[float], confidence: float = 0.95
) -> Agreement | None:
    """Return the agreement of a figure over stops, None where no stop has both numbers."""
    pairs = [
        (one, other)
        for one, other in zip(recorded, simulated, strict=True)
        if math.isfinite(one) and math.isfinite(other)
    ]
    if not pairs:
        return None
    absolute = [other - one for one, other in pairs]
    positive = all(one > 0.0 for one, _ in pairs)
    relative = [(other - one) / one for one, other in pairs] if positive else None
    return Agreement(
        figure,
        unit,
        len(pairs),
        math.fsum(one for one, _ in pairs) / len(pairs),
        differences_of(absolute, confidence),
        None if relative is None else differences_of(relative, confidence),
    )


def differences_of(values: Sequence[float], confidence: float) -> Differences:
    """Return bias and spread of differences, at least one. Student's t, which takes them for normal draws.

    Differences that are all alike have no intervals: t would feign certainty.
    """
    mean = math.fsum(values) / len(values)
    spread = math.nan
    if len(values) > 1:
        spread = math.sqrt(math.fsum((each - mean) ** 2 for each in values) / (len(values) - 1))
    if min(values) == max(values):
        return Differences(mean, spread, *[math.nan] * 4)
    interval, limits = mean_interval(values, confidence), next_interval(values, confidence)
    return Differences(mean, spread, *interval, *limits)


RESULT: Final = "validation.json"
"""Name of the file of a result."""


@dataclass(frozen=True, slots=True)
class Validation:
    """What recorded stops have shown of the model.

    Attributes:
        name: name of the validation.
        title: one line for people.
        version: version of uictest that simulated.
        confidence: confidence of the intervals.
        inputs: every file that was read, and its SHA-256.
        stops: all of them, those that are not counted too.
        figures: agreement of each figure over the counted stops.
        not_compared: figures that no counted stop has both recorded and simulated.
        domains: where it holds.
    """

    __pydantic_config__: ClassVar = ConfigDict(extra="forbid", defer_build=True)

    name: str
    title: str
    version: str
    confidence: float
    inputs: Mapping[str, str]
    stops: tuple[ComparedStop, ...]
    figures: tuple[Agreement, ...]
    not_compared: tuple[str, ...]
    domains: tuple[Domain, ...]

    @property
    def counted(self) -> tuple[ComparedStop, ...]:
        """The stops that bias, spread and domain are of."""
        return tuple(stop for stop in self.stops if stop.counted)

    @property
    def not_usable(self) -> tuple[ComparedStop, ...]:
        """The stops that should have counted and cannot; one that is only tuned is none of them."""
        return tuple(stop for stop in self.stops if stop.not_counted)


@dataclass(frozen=True, slots=True)
class ValidationReference:
    """A validation that cases are held against; its file as shown to users, and the SHA-256 of that."""

    validation: Validation
    file: str
    sha256: str

    def domains_of(self, parts: Mapping[str, Mapping[str, EffectivePart]]) -> dict[str, DomainOfValidity]:
        """Return whether cases lie in its domain, by id; `parts` has their parts by id and role."""
        return {case_id: self.domain_of(of_case) for case_id, of_case in parts.items()}

    def domain_of(self, parts: Mapping[str, EffectivePart]) -> DomainOfValidity:
        """Return whether a case, whose parts are given by role, lies in its domain."""
        outside = deviations(self.validation.domains, conditions_of(parts))
        return DomainOfValidity(self.validation.name, self.sha256, outside)


_VALIDATION: Final = TypeAdapter(Validation)


def validation_json(validation: Validation) -> str:
    """Return a validation as JSON; NaN is null."""
    form = {**envelope.head(envelope.RESULT, "validation"), **to_json_form(_VALIDATION, validation)}
    return json.dumps(form, indent=2, allow_nan=False) + "\n"


def read_validation(path: Path) -> ValidationReference:
    """Return the validation in a file.

    Raises OSError, and ValueError where the file is none, or none of its stops is counted.
    """
    if path.exists() and not path.is_file():  # a pipe would block for ever
        raise ValueError("not the result of a validation: this is no regular file")
    content = path.read_bytes()
    try:
        form = json.loads(content)
    except RecursionError as error:
        raise ValueError("not the result of a validation: it is nested too deeply") from error
    try:
        envelope.require(form if isinstance(form, dict) else {}, envelope.RESULT, "validation")
    except ValueError as error:
        raise ValueError(f"not the result of a validation: {error}") from error
    own = {name: value for name, value in form.items() if name not in ("schema", "kind")}
    validation = from_json_form(_VALIDATION, own)
    if not validation.domains:
        raise ValueError("none of its stops is counted: nothing was validated")
    return ValidationReference(validation, display_name(path), hashlib.sha256(content).hexdigest())


_WHEELSETS: Final = (1, 2, 3, 4)


@dataclass(frozen=True, slots=True)
class StopUnderConditions:
    """A compared stop and its conditions: as planned and as recorded."""

    stop: ComparedStop
    conditions: Sequence[Conditions]


def validation_of(
    plan: ValidationPlan, stops: Sequence[StopUnderConditions], inputs: Mapping[str, str]
) -> Validation:
    """Return the agreement of compared stops.

    Args:
        plan: what was planned.
        stops: all of them; those that are not counted are listed and play no part.
        inputs: every file that was read, and its SHA-256.
    """
    counted = [each for each in stops if each.stop.counted]
    figures = {name: _agreement_of_figure(name, counted, plan.confidence) for name in figure_names()}
    return Validation(
        name=plan.name,
        title=plan.title,
        version=__version__,
        confidence=plan.confidence,
        inputs=dict(inputs),
        stops=tuple(each.stop for each in stops),
        figures=tuple(each for each in figures.values() if each is not None),
        not_compared=tuple(name for name, each in figures.items() if each is None),
        domains=domains_of(each.conditions for each in counted),
    )


def figure_names() -> Iterator[str]:
    """Yield the figures of a stop, then those of each wheelset."""
    yield from STOP_COLUMNS
    for name in WHEELSET_COLUMNS:
        yield from (f"{name}_{number}" for number in _WHEELSETS)


def _agreement_of_figure(
    name: str, counted: Sequence[StopUnderConditions], confidence: float
) -> Agreement | None:
    recorded = [each.stop.recorded.get(name, float("nan")) for each in counted]
    simulated = [each.stop.simulated.get(name, float("nan")) for each in counted]
    return agreement_of(name, column_unit(name), recorded, simulated, confidence)
