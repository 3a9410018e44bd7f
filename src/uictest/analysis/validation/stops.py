"""Recorded stops beside their simulations."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from uictest.judging.evaluation import CaseResult, Number
from uictest.plans.scenario import Case
from uictest.plans.scenario.yaml import parse_quantity

Figures = Mapping[str, Number]
"""Column of results, of a wheelset `maximum_slide_1` -> number; NaN where it is not known."""


@dataclass(frozen=True, slots=True)
class ComparedStop:
    """One recorded stop and its simulation.

    Attributes:
        id: of both.
        recording: file, as shown to users.
        sha256: of the file.
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
