"""The conditions that recorded stops are judged under: those of a scenario, or stated one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from uictest.plans import scenario as scenarios
from uictest.recorded import field_data

CaseOfStop = Callable[[str, float], "scenarios.Case"]
"""Returns the case that a recorded stop is judged as: from its name and its initial speed, m/s."""


class MissingStatementsError(Exception):
    """A recording does not say what was tested, and nobody else does; `keys` are those to state."""

    def __init__(self, keys: Sequence[str]) -> None:
        self.keys = tuple(keys)
        super().__init__(*keys)


def statements_of(
    criteria: Sequence[str] | None, rail: str | None, position: str | None, wsp: str | None
) -> Iterator[str]:
    """Yield what is stated of recordings in the form of `--set`."""
    listed = f"[{', '.join(criteria)}]" if criteria else None
    stated = {"rail.condition": rail, "brake.position": position, "rig.wsp": wsp, "criteria": listed}
    yield from (f"{key}={text}" for key, text in stated.items() if text is not None)


def case_of_stop(
    case: scenarios.Case | None, statements: Sequence[str], trusted: Sequence[Path] | None
) -> CaseOfStop:
    """Return the function that makes the case of a recording: as `case` states, or the statements alone.

    Raises MissingStatementsError if there is neither a case nor every statement that is needed.
    """
    if case is not None:
        return lambda name, speed: case
    keys = {statement.partition("=")[0].strip() for statement in statements}
    missing = [key for key in field_data.REQUIRED_STATEMENTS if key not in keys]
    if missing:
        raise MissingStatementsError(missing)
    return lambda name, speed: field_data.stated_case(name, speed, statements, trusted or ())
