"""One criterion on many stops: statuses, margins and, where they are asked for, reasons.

What one stop decides alone and what many decide together comes from the same functions: whether the criterion
applies, the value of its measure and the text of the reason. Only comparing values with bounds is written a
second time here, for arrays.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from uictest.core.ensemble import Places, by_way
from uictest.core.measures import MEASURES
from uictest.judging.evaluation.bounds import Bounds, ObservedStop, bounds_of
from uictest.judging.evaluation.decision import Decision, read_measure, too_few_wheelsets, why_decided
from uictest.judging.evaluation.judgement import OVER_A_SERIES, undecided
from uictest.judging.evaluation.rig_reasons import why_rig_fails
from uictest.judging.evaluation.verdict import Layer, Status
from uictest.plans import scenario
from uictest.plans.scenario import UnmetCondition, test_conditions_of, unmet_conditions

Numbers = NDArray[np.float64]
STATUSES: tuple[Status, ...] = ("pass", "fail", "not_applicable", "inconclusive")
WHEELSET_COUNT = 4
"""Wheelsets of a simulated stop."""
_PASS, _FAIL, _NOT_APPLICABLE = map(STATUSES.index, ("pass", "fail", "not_applicable"))
Seen = tuple[scenario.Scenario, ObservedStop]
"""Scenario and stop of one case, or of several with ensembles in place of their numbers."""


@dataclass(frozen=True)
class BlockVerdicts:
    """One criterion's verdicts on n stops.

    `statuses` are places in :data:`STATUSES`. `margins` are those of
    :func:`~uictest.judging.evaluation.verdict.relative_margin`; `has_margin` says where there is one, since a
    margin itself may be NaN. `near_limit` says where the value lies within the bias from a bound, or data
    are missing. `reason` returns the reason of the verdict at a place.
    """

    id: str
    layer: Layer
    statuses: NDArray[np.int8]
    margins: Numbers
    has_margin: NDArray[np.bool_]
    near_limit: NDArray[np.bool_]
    reason: Callable[[int], str]


def block_verdicts(
    criterion: scenario.Criterion,
    together: Callable[[Places], Seen],
    alone: Callable[[int], Seen],
    count: int,
    bias: float = 0.0,
) -> BlockVerdicts:
    """Return a criterion's verdicts on `count` simulated stops, which all came to a standstill.

    `together` and `alone` give scenario and stop at several places, and at one place. `bias` is that of the
    values, as a share of them; infinite where it is not known.
    """
    if criterion.needs_series:
        return _of_series(criterion, count)
    statuses = np.zeros(count, np.int8)
    reasons: dict[int, Callable[[], str]] = {}
    values = np.full((count, WHEELSET_COUNT if MEASURES[criterion.measure].of_wheelsets else 1), np.nan)
    has_value = np.zeros(count, bool)
    near_limit = np.zeros(count, bool)
    for places, found in by_way(
        lambda places: _values_or_decision(criterion, *together(places)),
        lambda place: _values_or_decision(criterion, *alone(place)),
        np.arange(count),
    ):
        if isinstance(found, tuple):
            has_value[places] = True
            for wheelset, numbers in enumerate(found):
                values[places, wheelset] = numbers
        elif isinstance(found, Decision):
            statuses[places] = STATUSES.index(found.status)
            near_limit[places] = found.status == "inconclusive"
            reasons |= dict.fromkeys(places.tolist(), partial(str, found.reason))
        else:
            statuses[places] = _NOT_APPLICABLE
            reasons |= {place: partial(_joined, found, k) for k, place in enumerate(places.tolist())}
    where = criterion.speed_range(criterion.definition.stated())
    bounded = BoundedValues(values, bounds_of(criterion), criterion.wheelsets_needed(values.shape[1]), where)
    statuses[has_value] = np.where(bounded.hold, _PASS, _FAIL)[has_value]

    def reason(place: int) -> str:
        if place in reasons:
            return reasons[place]()
        if criterion.layer == "rig":
            resolved, stop = alone(place)
            if why := why_rig_fails(criterion, resolved, stop.measures, list(stop.wheelsets)):
                return why
        return bounded.reason(place, criterion.unit)

    margins, has_margin = bounded.relative_margins
    near_limit |= has_value & bounded.within(bias)
    return BlockVerdicts(
        *(criterion.id, criterion.layer, statuses, margins, has_margin & has_value, near_limit, reason)
    )


def _of_series(criterion: scenario.Criterion, count: int) -> BlockVerdicts:
    """Return that no stop is judged by a criterion of series."""
    nothing = np.zeros(count, bool)
    statuses = np.full(count, _NOT_APPLICABLE, np.int8)
    margins = np.full(count, np.nan)
    return BlockVerdicts(
        *(criterion.id, criterion.layer, statuses, margins, nothing, nothing), lambda place: OVER_A_SERIES
    )


def _joined(unmet: Sequence[UnmetCondition], number: int) -> str:
    return "; ".join(str(condition.in_case(number)) for condition in unmet)


def _values_or_decision(
    criterion: scenario.Criterion, resolved: scenario.Scenario, stop: ObservedStop
) -> tuple[float, ...] | Decision | list[UnmetCondition]:
    """Return the values that decide a criterion, in its unit; or why there are none.

    That is the decision, or the conditions that are not met, whose text has the numbers of one stop.
    """
    conditions = test_conditions_of(resolved)
    if unmet := unmet_conditions(criterion.applies, conditions, stop.measures.initial_speed):
        return unmet
    decided = undecided(criterion, conditions, stop, resolved.measures)
    if decided is not None:
        return decided
    observed = read_measure(criterion, criterion.definition.stated(), stop)
    if observed.unavailable_reason:
        return Decision("not_applicable", None, observed.unavailable_reason)
    count = len(observed.values)
    return observed.values if 1 <= criterion.wheelsets_needed(count) <= count else too_few_wheelsets(count)


@dataclass(frozen=True)
class BoundedValues:
    """Values of a measure of n stops, shape (n, 1) or (n, wheelsets), and their bounds in the same unit.

    What :class:`~uictest.judging.evaluation.bounds.Bounds` and
    :func:`~uictest.judging.evaluation.bounds.deciding` say of the values of one stop, to the last bit;
    `needed` of the values must keep the bounds. `where` says at which train speeds the measure looks.
    """

    values: Numbers
    bounds: Bounds
    needed: int
    where: str = ""

    @cached_property
    def deciding(self) -> Numbers:
        """The value that decides, for each stop."""
        if self.values.shape[1] == 1:
            return self.values[:, 0]
        merits = np.where(np.isfinite(self.values), self._margins(self.values), -np.inf)
        order = np.argsort(-merits, axis=1, kind="stable")
        deciding: Numbers = np.take_along_axis(self.values, order[:, self.needed - 1 : self.needed], axis=1)
        return deciding[:, 0]

    @cached_property
    def hold(self) -> NDArray[np.bool_]:
        """Whether the deciding value keeps the bounds. NaN and infinity never do."""
        margins = self._margins(self.deciding)
        kept = margins > 0.0 if self.bounds.strict else margins >= 0.0
        return np.asarray(np.isfinite(self.deciding) & kept)

    def within(self, share: float) -> NDArray[np.bool_]:
        """Return whether a change of the deciding value by less than a share of it reaches a bound.

        So does any change of a value that lies at its bound.
        """
        if math.isinf(share):
            return np.ones(self.deciding.size, bool)
        distances = np.abs(self._margins(self.deciding))
        near = (distances < share * np.abs(self.deciding)) | ((distances == 0.0) & (share > 0.0))
        return np.asarray(near)

    @property
    def relative_margins(self) -> tuple[Numbers, NDArray[np.bool_]]:
        """Margins over the bound, and where there is one."""
        margins = self._margins(self.deciding)
        has_margin = ~np.isnan(self.deciding) & ~((margins == 0.0) & self.hold)
        bound = max(abs(self.bounds.lower or 0.0), abs(self.bounds.upper or 0.0))
        return margins / bound if bound else np.where(margins > 0.0, 0.0, margins), has_margin

    def reason(self, place: int, unit: str) -> str:
        """Return why the values of one stop keep or miss their bounds."""
        value = float(self.deciding[place])
        return why_decided(self.values[place].tolist(), value, self.bounds, self.needed, unit, self.where)

    def _margins(self, values: Numbers) -> Numbers:
        lower = -math.inf if self.bounds.lower is None else self.bounds.lower
        upper = math.inf if self.bounds.upper is None else self.bounds.upper
        with np.errstate(invalid="ignore"):
            above_lower, below_upper = values - lower, upper - values
        # As `min` orders them where one is NaN: that of an infinite value without a bound on its side.
        return np.where(below_upper < above_lower, below_upper, above_lower)
