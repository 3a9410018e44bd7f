"""Bias and spread of a figure: simulated minus recorded, over stops."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from uictest.core.statistics import mean_interval, next_interval
from uictest.judging.evaluation import Number


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
