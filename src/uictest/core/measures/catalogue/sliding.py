"""How far and how long the wheelsets slide, what wears flats by it, and how long they are locked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from uictest.core.measures.measure import (
    DefinitionValues,
    Measure,
    MeasureValue,
    Overview,
    RecordedData,
    ShownWhen,
    StopColumn,
    WheelsetColumn,
    Wheelsets,
    unavailable,
)
from uictest.core.measures.records import END_SPEEDS, SLOW_SHARES, StopMeasures
from uictest.core.units import KILOMETRE_PER_HOUR, PERCENT

SLIDE_CLASS: Final = 10.0 * KILOMETRE_PER_HOUR
"""m/s: `maximum_slide_above[k]` counts while the train runs faster than k of these (10 km/h each)."""

SLOW_SHARE_CLASS: Final = 5.0 * PERCENT
"""Times spent sliding are kept for shares of the train's speed that are multiples of it, 85 to 95 %."""

_WHEEL_SPEEDS = RecordedData(("speed", "wheel_speed_{n}"))
_SHARED = RecordedData(("speed", "wheel_speed_{n}"), bounded=False)
_OF_FLATS = ("sliding_slide", "sliding_slip", "moving_speed")
_OF_LOCKS = ("locked_speed", "moving_speed")


def maximum_slide_above_cutoff(
    stop: StopMeasures, wheelsets: Wheelsets, low_speed_cutoff: float
) -> MeasureValue:
    """Return the largest slide (share; 1 = locked) of each wheelset above the cut-off.

    Slides count while the train runs faster than `low_speed_cutoff` (m/s), a multiple of 10 km/h, as the
    measures keep one value per such class. There is no value for a train that never ran faster.
    """
    k = round(low_speed_cutoff / SLIDE_CLASS)
    slides = tuple(float(wheelset.maximum_slide_above[k]) for wheelset in wheelsets)
    if not stop.initial_speed > low_speed_cutoff or all(map(math.isnan, slides)):
        return unavailable(f"the train never ran faster than the cut-off of {10 * k} km/h")
    return MeasureValue(slides)


def sliding_share(stop: StopMeasures, definition: DefinitionValues) -> MeasureValue:
    """Return the share of time in which at least half of the wheelsets slide at once.

    Time runs from the brake command to the first sample at or below `end_speed` (m/s); a wheelset slides
    while it turns slower than the share `sliding_below` of the train's speed (TB/T 3009-2019, clause 3,
    second-hand).
    """
    return _sliding_shares(stop, definition, [stop.half_slow_time])


def sliding_share_of_wheelsets(
    stop: StopMeasures, wheelsets: Wheelsets, definition: DefinitionValues
) -> MeasureValue:
    """Return the share of time in which each wheelset slides, else as :func:`sliding_share`."""
    return _sliding_shares(stop, definition, [wheelset.slow_time for wheelset in wheelsets])


def _sliding_shares(
    stop: StopMeasures, definition: DefinitionValues, tables: Sequence[Sequence[float]]
) -> MeasureValue:
    first = _index_of_slow_time(definition)
    k = first // len(SLOW_SHARES)
    end = f"{_kilometres_per_hour(definition['end_speed'])}, down to which sliding counts"
    if not stop.initial_speed > END_SPEEDS[k]:
        why = f"the train did not run faster than {end}"
        return MeasureValue(unavailable_reason=why, whatever_follows=True)
    if math.isnan(stop.reached_time[k]):
        return unavailable(f"the train did not come down to {end}")
    duration = float(stop.reached_time[k])
    indices = range(first, len(END_SPEEDS) * len(SLOW_SHARES), len(SLOW_SHARES))
    return MeasureValue(tuple(sum(float(table[index]) for index in indices) / duration for table in tables))


def _index_of_slow_time(definition: DefinitionValues) -> int:
    """Return the index of `sliding_below` in the band of train speeds that ends at `end_speed`."""
    k = round(definition["end_speed"] / SLIDE_CLASS) - 1
    j = round((definition["sliding_below"] - SLOW_SHARES[0]) / SLOW_SHARE_CLASS)
    return k * len(SLOW_SHARES) + j


def _down_to_end_speed(definition: DefinitionValues) -> str:
    return f"from the brake command to {_kilometres_per_hour(definition['end_speed'])}"


def _kilometres_per_hour(speed: float) -> str:
    return f"{10 * round(speed / SLIDE_CLASS)} km/h"


MEASURES = (
    Measure(
        name="maximum_slide_above_cutoff",
        kind="share",
        course="grows",
        better="smaller",
        meaning="largest slide (v - r omega)/v while the train runs faster than the low-speed cut-off",
        field="maximum_slide",
        read=lambda stop, wheelsets, definition: maximum_slide_above_cutoff(
            stop, wheelsets, definition["low_speed_cutoff"]
        ),
        decided=ShownWhen(
            how="extreme",
            plot="slide",
            field="maximum_slide_above",
            index=lambda definition: round(definition["low_speed_cutoff"] / SLIDE_CLASS),
            down_to="low_speed_cutoff",
            level=True,
        ),
        of_wheelsets=True,
        definitions=("low_speed_cutoff",),
        speed_range=lambda definition: f"above {_kilometres_per_hour(definition['low_speed_cutoff'])}",
        observed_by=("moving_speed",),
        recorded=_WHEEL_SPEEDS,
        column=WheelsetColumn(
            "maximum_slide",
            "1",
            meaning="largest slide (v - r omega)/v as a share, 1 where locked, at all speeds above"
            " `moving_speed`: criteria bound the largest above their own cut-off,"
            " `maximum_slide_above_cutoff`",
            overview=Overview(
                "largest slide\nabove {}, %", digits=1, rank=4, short="max slide %\n> {}", few_digits=0
            ),
        ),
        finite_field="maximum_slide",
    ),
    Measure(
        name="sliding_duration",
        kind="time",
        course="grows",
        better="smaller",
        meaning="time the wheelset slides in all",
        decided=ShownWhen(how="intervals", plot="sliding", field="sliding_duration"),
        of_wheelsets=True,
        observed_by=("sliding_slide", "sliding_slip", "moving_speed"),
        recorded=_WHEEL_SPEEDS,
        column=WheelsetColumn("sliding_time_s", "s", overview=Overview("sliding\nmax s", digits=1, rank=10)),
        finite_field="sliding_duration",
    ),
    Measure(
        name="sliding_share",
        kind="share",
        share_of="of the time",
        course="settles",
        meaning="share of the time from the brake command to `end_speed` in which at least half of the"
        " wheelsets turn, at once, below the share `sliding_below` of the train's speed",
        of_braking=True,
        read=lambda stop, _, definition: sliding_share(stop, definition),
        decided=ShownWhen(how="span", plot="slide", down_to="end_speed"),
        definitions=("sliding_below", "end_speed"),
        speed_range=_down_to_end_speed,
        recorded=_SHARED,
        column=StopColumn(
            "sliding_share",
            "1",
            read=lambda stop, definition: next(iter(sliding_share(stop, definition).values), math.nan),
            defaults={"sliding_below": 90.0 * PERCENT, "end_speed": 60.0 * KILOMETRE_PER_HOUR},
        ),
    ),
    Measure(
        name="sliding_share_of_wheelsets",
        kind="share",
        share_of="of the time",
        course="settles",
        meaning="share of the time from the brake command to `end_speed` in which the wheelset turns below"
        " the share `sliding_below` of the train's speed",
        read=sliding_share_of_wheelsets,
        decided=ShownWhen(
            how="span", plot="slide", field="slow_time", index=_index_of_slow_time, down_to="end_speed"
        ),
        of_wheelsets=True,
        definitions=("sliding_below", "end_speed"),
        speed_range=_down_to_end_speed,
        recorded=_SHARED,
    ),
    Measure(
        name="slid_distance",
        kind="length",
        course="grows",
        better="smaller",
        meaning="distance that the train runs while the wheelset slides or is locked",
        of_braking=True,
        decided=ShownWhen(how="intervals", plot="sliding", field="slid_distance"),
        of_wheelsets=True,
        observed_by=_OF_FLATS,
        recorded=RecordedData(("speed", "wheel_speed_{n}")),
        column=WheelsetColumn("slid_distance_m", "m"),
        finite_field="slid_distance",
    ),
    Measure(
        name="contact_energy",
        kind="energy",
        course="grows",
        better="smaller",
        meaning="energy that both contacts of the wheelset turn into heat while it slides or is locked",
        decided=ShownWhen(how="intervals", plot="sliding", field="contact_energy"),
        of_wheelsets=True,
        observed_by=_OF_FLATS,
        recorded=RecordedData(("speed", "wheel_speed_{n}", "adhesion_{n}", "wheel_load_{n}"), computed=True),
        column=WheelsetColumn("contact_energy_kj", "kJ"),
        finite_field="contact_energy",
    ),
    Measure(
        name="locked_time",
        kind="time",
        course="grows",
        better="smaller",
        meaning="time the wheelset is locked in all",
        decided=ShownWhen(how="intervals", plot="locked", field="locked_time"),
        of_wheelsets=True,
        observed_by=_OF_LOCKS,
        recorded=_WHEEL_SPEEDS,
        column=WheelsetColumn("locked_time_s", "s", overview=Overview("locked\nmax s", digits=1, rank=9)),
        approach="maximum_slide",
        finite_field="locked_time",
    ),
    Measure(
        name="longest_lock",
        kind="time",
        course="grows",
        better="smaller",
        meaning="longest time the wheelset is locked at a stretch",
        decided=ShownWhen(how="longest", plot="locked", field="lock"),
        of_wheelsets=True,
        observed_by=_OF_LOCKS,
        recorded=_WHEEL_SPEEDS,
        approach="maximum_slide",
        finite_field="longest_lock",
    ),
)
