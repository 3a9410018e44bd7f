"""Read what is to be validated, and what was."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest.analysis import validation
from uictest.plans import validation as validation_plans
from uictest.runs.scenario_files import InvalidInputError, is_series, load_series


def load_validations(
    paths: Sequence[Path], overrides: Sequence[str] | None = None, trusted: Sequence[Path] | None = None
) -> list[validation_plans.ValidationPlan]:
    """Return the validations of validation and series files. Raises ScenarioErrors, InvalidInputError."""
    plans: list[validation_plans.ValidationPlan] = []
    for path in paths:
        if is_series(path):
            plans += map(validation_plans.plan_of_series, load_series([path], overrides, None, trusted))
        else:
            plans.append(validation_plans.load_validation(path, tuple(overrides or ()), trusted or ()))
    for plan in plans:
        if not plan.comparisons:
            raise InvalidInputError(f"{plan.path}: no stop names a recording: list them under `recordings`")
    return plans


def reference_of(option: Path | None, named: str | None) -> validation.ValidationReference | None:
    """Return the validation of an option, else that which a scenario names. Raises InvalidInputError."""
    path = option or (None if named is None else Path(named))
    return None if path is None else read_reference(path)


def read_reference(path: Path) -> validation.ValidationReference:
    """Return the validation that cases are held against. Raises InvalidInputError."""
    try:
        return validation.read_validation(path)
    except OSError as error:
        raise InvalidInputError(f"{path}: {error.strerror or error}") from error
    except ValueError as error:
        raise InvalidInputError(f"{path}: {error}") from error
