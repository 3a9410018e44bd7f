"""The observed part of a stop, and what its measures lack."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from uictest.core.measures import StopMeasures, Wheelsets
from uictest.core.units import in_unit, value_text
from uictest.plans import scenario


@dataclass(frozen=True, slots=True)
class MissingData:
    """What a value of a measure lacks, in words.

    `bounded`: the data that there are bound the value, as part of a stop does; otherwise it may be anything.
    """

    reason: str
    bounded: bool = True

    def and_also(self, reason: str) -> MissingData:
        """Return this with a second reason; where the value may be anything, the first suffices."""
        return MissingData(f"{self.reason}; {reason}") if self.bounded else self


@dataclass(frozen=True, slots=True)
class Coverage:
    """What the record of a real stop lacks before its end.

    Args:
        missing: measure -> what each of its values lacks (one for the stop, or one per wheelset), None where
            nothing; measures that are known throughout the record are left out.
        no_initial_speed: why the initial speed is not known; empty where it is.
        not_computed: measure -> the channels that it is computed from and that the record does not have.

    """

    missing: Mapping[str, tuple[MissingData | None, ...]]
    no_initial_speed: str = ""
    not_computed: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ObservedStop:
    """The measures of a stop as far as it was observed.

    `cut_off` says why that was not to standstill; empty where it was. `coverage` is None for a simulation.
    """

    measures: StopMeasures
    wheelsets: Wheelsets
    cut_off: str = ""
    coverage: Coverage | None = None

    def missing(self, measure: str, count: int, *, settled: bool) -> tuple[MissingData | None, ...]:
        """Return what each of the `count` values of a measure lacks; empty where none lacks anything.

        To a value that is `settled` the end of the observation does not matter.
        """
        gaps = self.coverage.missing.get(measure, ()) if self.coverage else ()
        if settled or not self.cut_off:
            return gaps
        end = MissingData(self.cut_off)
        return tuple(gap.and_also(self.cut_off) if gap else end for gap in gaps or (None,) * count)


def why_cut_off(resolved: scenario.Scenario, measures: StopMeasures, coverage: Coverage | None) -> str:
    """Return why a stop was not observed to standstill; empty where it was."""
    if measures.stopped:
        return ""
    speed = (
        "an unknown speed"
        if math.isnan(measures.end_speed)
        else value_text(in_unit(measures.end_speed, "km/h"), "km/h")
    )
    if coverage is not None:
        return f"the record ends after {value_text(measures.end_time, 's')} with the train at {speed}"
    limit = resolved.simulation.maximum_duration.text
    return f"the simulation ended after {limit} at {speed}; raise `simulation.maximum_duration`"
