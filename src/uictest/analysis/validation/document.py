"""The result of a validation and its JSON form, schema uictest/validation-result/1."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import ConfigDict, TypeAdapter

from uictest.analysis.validation.agreement import Agreement
from uictest.analysis.validation.conditions import conditions_of
from uictest.analysis.validation.domain import Domain, deviations
from uictest.analysis.validation.stops import ComparedStop
from uictest.judging.evaluation import DomainOfValidity, EffectivePart, from_json_form, to_json_form
from uictest.plans.scenario import VALIDATION_RESULT
from uictest.plans.scenario.yaml import display_name

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


# Of a list: its configuration then holds for everything inside.
_VALIDATIONS: Final = TypeAdapter(list[Validation], config=ConfigDict(extra="forbid", defer_build=True))


def validation_json(validation: Validation) -> str:
    """Return a validation as JSON; NaN is null."""
    [content] = to_json_form(_VALIDATIONS, [validation])
    form: dict[str, Any] = {"schema": VALIDATION_RESULT, **content}
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
    if not isinstance(form, dict) or form.pop("schema", None) != VALIDATION_RESULT:
        raise ValueError(
            f"not the result of a validation: expected a document with the schema {VALIDATION_RESULT}"
        )
    [validation] = from_json_form(_VALIDATIONS, [form])
    if not validation.domains:
        raise ValueError("none of its stops is counted: nothing was validated")
    return ValidationReference(validation, display_name(path), hashlib.sha256(content).hexdigest())
