"""Recorded stops beside their simulations, and the bias and spread of a figure over them."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from uictest.core.statistics import mean_interval, next_interval
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
        unit: of the figure.
        stops: in which both are known.
        recorded_mean: of the recorded figures.
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
    """Return what differences, at least one, come to. Student's t, which takes them for normal draws.

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
