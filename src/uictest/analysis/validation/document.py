"""The result of a validation, summed up from its stops, and its JSON form."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Final

from pydantic import ConfigDict, TypeAdapter

from uictest import __version__
from uictest.analysis.validation.domain import Conditions, Domain, conditions_of, deviations, domains_of
from uictest.analysis.validation.stops import Agreement, ComparedStop, agreement_of
from uictest.core import envelope
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, column_unit
from uictest.judging.evaluation import DomainOfValidity, EffectivePart, from_json_form, to_json_form
from uictest.plans.scenario.yaml import display_name
from uictest.plans.series import ValidationPlan

RESULT: Final = "validation.json"
"""Name of the file of a result."""


@dataclass(frozen=True, slots=True)
class Validation:
    """What recorded stops have shown of the model.

    Attributes:
        name: of the validation.
        title: one line for people.
        version: of uictest that simulated.
        confidence: of the intervals.
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
    """Return what compared stops come to.

    Args:
        plan: what was planned.
        stops: all of them; those that are not counted are listed and play no part.
        inputs: every file that was read, and its SHA-256.
    """
    counted = [each for each in stops if each.stop.counted]
    figures = {name: _agreement(name, counted, plan.confidence) for name in figure_names()}
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


def _agreement(name: str, counted: Sequence[StopUnderConditions], confidence: float) -> Agreement | None:
    recorded = [each.stop.recorded.get(name, float("nan")) for each in counted]
    simulated = [each.stop.simulated.get(name, float("nan")) for each in counted]
    return agreement_of(name, column_unit(name), recorded, simulated, confidence)
