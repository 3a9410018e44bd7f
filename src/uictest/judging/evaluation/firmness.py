"""Whether a verdict hangs on numbers that nobody measured: the share of draws in which it stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Literal

from pydantic import PlainSerializer

from uictest.judging.evaluation.json_values import BuiltWhenUsed, OptionalNumber, absent_if_empty, json_form

FirmnessStatus = Literal["firm", "turns", "noise", "not_shown"]
"""firm: no value at an end of its range, and no draw of all of them, turns the verdict. turns: one does.
noise: it turns over the seeds at the nominal values, too. not_shown: nothing turned it,
in too few draws that count."""


@dataclass(frozen=True, slots=True)
class Turn:
    """A number that turns a verdict alone, while all others have their nominal values.

    Args:
        key: where it stands in the scenario.
        side: side of its nominal value on which the verdict turns.
        criterion: id of the criterion that turns.
        to: its status there.
        value: beyond which it turns under most seeds, as a scenario has it; empty where there is no such
            value: it turns in several places, or under few seeds only.
        stands_to: the last value found, from the nominal one, at which it stands under every seed. It is the
            nominal one where the end turns few seeds: no turning value is searched then.
        turned_from: the first value found from which on it is turned under every seed; empty where there is
            none.
        end: the end of the range on this side.

    """

    key: str
    side: Literal["below", "above"]
    criterion: str
    to: str
    value: str
    stands_to: str
    turned_from: str
    end: str


@dataclass(frozen=True, slots=True)
class CalibratedDraws:
    """In which share of the draws that keep to what is known of the numbers a verdict stands.

    Args:
        counted: draws that count and under which the calibrating stops come to what they should.
        share: share of these in which the verdict stands; None without any.

    """

    counted: int
    share: OptionalNumber


@dataclass(frozen=True, slots=True, kw_only=True)
class VerdictFirmness:
    """How firm one verdict is.

    Args:
        criterion: its id; empty for the outcome.
        nominal: what it is at the nominal values, under most seeds.
        status: see :data:`FirmnessStatus`.
        counted: draws of all numbers together that count: the stop could be run, and was a valid test.
        turned: those of them in which the verdict is another.
        share: share of counted draws in which it stands; None without any.
        share_at_least: bound of that share with 95 % confidence where no draw turned it: 0.05^(1/counted), as
            if the draws were independent; else None.
        lowest_block: lowest share in one of the blocks of draws.
        highest_block: highest share in one of them.
        calibrated: the same of the calibrated draws alone; None where no stops calibrate.
        margin: median over the seeds at nominal values, as a share of the limit; None where it has none.
        turned_by: the numbers that turn it alone.

    """

    criterion: str = ""
    nominal: str
    status: FirmnessStatus
    counted: int
    turned: int
    share: OptionalNumber
    share_at_least: OptionalNumber
    lowest_block: OptionalNumber
    highest_block: OptionalNumber
    calibrated: CalibratedDraws | None = None
    margin: OptionalNumber
    turned_by: tuple[Turn, ...] = ()


@dataclass(frozen=True, slots=True)
class NumberEffect:
    """A number with a plausible range, and what it does to the margins.

    Args:
        key: where it stands in the scenario.
        value: nominal, as written.
        lowest: end of its range, as written.
        highest: the other end.
        mark: mark of the value: stated, published, identified, chosen, or user.
        reason: why its range and its prior are what they are.
        margins: criterion -> its margin at the lowest and at the highest value, as a share of the limit:
            medians over some seeds; None where a stop has none.
        prior: how likely the values of its range are in the draws: uniform or log-uniform; empty in a
            document that does not say.

    """

    key: str
    value: str
    lowest: str
    highest: str
    mark: str
    reason: str
    margins: Annotated[Mapping[str, tuple[OptionalNumber, OptionalNumber]], PlainSerializer(json_form)] = (
        field(default_factory=dict)
    )
    prior: str = ""

    def effect(self, criterion: str, nominal: float | None) -> float:
        """Return the largest change of a criterion's margin at an end; 0 where it is not known."""
        ends = [each for each in self.margins.get(criterion, ()) if each is not None]
        return max((abs(each - nominal) for each in ends), default=0.0) if nominal is not None else 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Firmness(VerdictFirmness):
    """How firm the outcome of a case or a series is, and each of its verdicts.

    Args:
        criteria: how firm the verdicts are.
        numbers: all that were varied.
        draws: number of draws of all numbers together.
        infeasible: draws whose values do not fit together.
        not_run: keys of the numbers at an end of whose range, all others being nominal, no stop could be run.
        outcomes: outcomes of all draws: outcome -> number of draws; `error` counts the infeasible ones.
        seeds: under which the nominal stop was run.
        on_four_calipers: whether all of these stops were run on the rig with four calipers: numbers of the
            caliper, its tank or the valves vary, for which the compensation was not identified.
        in_survey_steps: whether they were simulated in survey steps, except where the known bias of these may
            have decided a verdict.
        calibrated_by: ids of the stops by which the numbers are known.
        without_range: keys of the friction of the rail, and of numbers of further brakes, sanders and
            couplers, that state no range.

    """

    criteria: tuple[Annotated[VerdictFirmness, absent_if_empty("calibrated")], ...]
    numbers: tuple[NumberEffect, ...]
    draws: int
    infeasible: int
    not_run: tuple[str, ...] = ()
    outcomes: Mapping[str, int]
    seeds: int
    on_four_calipers: bool
    in_survey_steps: bool = False
    calibrated_by: tuple[str, ...] = ()
    without_range: tuple[str, ...] = ()

    def shows(self, outcome: str) -> bool:
        """Return whether this very outcome is shown to be firm."""
        return (self.nominal, self.status) == (outcome, "firm")


WrittenFirmness = Annotated[
    Firmness,
    BuiltWhenUsed(
        Annotated[Firmness, absent_if_empty("criterion", "calibrated", "calibrated_by", "without_range")]
    ),
]
"""In JSON the outcome has no criterion, and what no stop calibrates no calibrated draws."""
