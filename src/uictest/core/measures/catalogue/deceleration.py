"""Deceleration and adhesion: of the first sliding, over what the rail could give, extremes, of each bogie."""

from __future__ import annotations

import math
from collections.abc import Callable
from operator import attrgetter
from typing import Any, Final

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
    one_value,
    unavailable,
    value_per_wheelset,
)
from uictest.core.measures.records import StopMeasures
from uictest.core.units import STANDARD_GRAVITY

_DEFAULT_FIRST_PHASE: Final = 3.0
"""s; chosen. Used for the column of a case none of whose criteria defines its own first phase."""
_OF_UTILISATION = ("sliding_slide", "sliding_slip", "moving_speed", "reduced_share")
_LIMITED_BY_RAIL = ShownWhen(how="intervals", plot="sliding", field="exploited_work")
_CONTACTS = RecordedData(
    (
        *("speed", "wheel_speed_{n}", "adhesion_{n}", "friction_{n}", "wheel_load_{n}"),
        *("tank_pressure_{n}", "brake_line_pressure"),
    ),
    bounded=False,
)
_FILTERING = ("deceleration_filter", "moving_speed")
_NEVER_DEVELOPED = "the brake was never fully developed while the train ran"
_POSITIONS = {1: "leading", 2: "trailing"}


def initial_adhesion(stop: StopMeasures, first_phase_duration: float, gradient: float = 0.0) -> MeasureValue:
    """Return (v(0) - v(T)) / T - g i in m/s2, T = `first_phase_duration` (s) counted from the first sliding.

    i is the gradient, positive uphill, where weight slows the train as well as the rail. v is known at whole
    seconds after the first sliding and taken as linear between them. There is no value where no wheelset
    slid, or where the train stood or the record ended before the phase was over: the phase would then not be
    one of sliding at all. Nor is there one where a track brake slowed the train as well, be it that of
    another car.
    """
    if stop.track_brake_time > 0.0:
        return unavailable("the track brake acted, so the deceleration is not that of the wheels' adhesion")
    if stop.track_brake_time_beside > 0.0:
        return unavailable(
            "the track brake of another car acted, so the deceleration is not that of the wheels' adhesion"
        )
    if not math.isfinite(stop.sliding_time):
        return unavailable("no wheelset slid, so the first phase has no beginning")
    at_start = float(stop.speed_after_sliding[0])
    at_end = _speed_after(stop, first_phase_duration)
    if not (at_start > 0.0 and at_end > 0.0):
        return unavailable(
            f"the stop or its record ended within {first_phase_duration:.4g} s of the first sliding"
        )
    return one_value((at_start - at_end) / first_phase_duration - STANDARD_GRAVITY * gradient)


def _initial_adhesion(stop: StopMeasures, definition: DefinitionValues) -> MeasureValue:
    return initial_adhesion(stop, definition["first_phase_duration"], definition["gradient"])


def _speed_after(stop: StopMeasures, seconds: float) -> float:
    """Return the train speed (m/s) `seconds` after the first sliding; NaN where it may not be running."""
    whole, known = math.floor(seconds), len(stop.speed_after_sliding)
    if not 0 <= whole < known:
        return math.nan
    before = float(stop.speed_after_sliding[whole])
    if seconds == whole:
        return before
    after = float(stop.speed_after_sliding[whole + 1]) if whole + 1 < known else math.nan
    return before + (seconds - whole) * (after - before) if after > 0.0 else math.nan


def utilisation_of_train(stop: StopMeasures) -> MeasureValue:
    """Return the share of a stop that ended at standstill."""
    return _why_no_utilisation(stop) or one_value(stop.adhesion_utilisation)


def utilisation_of_wheelsets(stop: StopMeasures, wheelsets: Wheelsets) -> MeasureValue:
    """Return the share of each wheelset; what never slid left nothing unused and has 1."""
    shares = (wheelset.adhesion_utilisation for wheelset in wheelsets)
    return _why_no_utilisation(stop) or value_per_wheelset(
        1.0 if math.isnan(share) else share for share in shares
    )


def _why_no_utilisation(stop: StopMeasures) -> MeasureValue | None:
    if not stop.stopped:
        return unavailable("no standstill")
    if math.isnan(stop.adhesion_utilisation):
        return unavailable("no wheelset slid, so that the rail never limited the brake")
    return None


def deceleration_of_bogie(stop: StopMeasures, deceleration: float) -> MeasureValue:
    """Return the mean deceleration that the rail gave through a bogie in a stop that ended at standstill."""
    return one_value(deceleration) if stop.stopped else unavailable("no standstill")


def _of_bogie(number: int) -> Measure:
    of_stop: Callable[[Any], float] = attrgetter(f"deceleration_bogie_{number}")
    return Measure(
        name=f"deceleration_bogie_{number}",
        kind="acceleration",
        unit="m/s2",
        course="settles",
        meaning=f"part of the mean deceleration given by the rail through the {_POSITIONS[number]} bogie: its"
        " work on both wheelsets over the mass of the train and the braking distance",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: deceleration_of_bogie(stop, of_stop(stop)),
        decided=ShownWhen(how="span", plot="deceleration", level=True, word=f"{_POSITIONS[number]} bogie"),
        recorded=RecordedData(("speed", "distance", "adhesion_{n}", "wheel_load_{n}"), bounded=False),
        column=StopColumn(
            f"deceleration_bogie_{number}_mps2",
            "m/s2",
            read=lambda stop, definition: of_stop(stop) if stop.stopped else math.nan,
        ),
        finite_field=f"deceleration_bogie_{number}",
    )


MEASURES = (
    Measure(
        name="initial_adhesion",
        kind="acceleration",
        unit="g",
        course="settles",
        meaning="mean deceleration of the train over the first phase, counted from the first sliding of any"
        " wheelset, less that by the gradient",
        of_braking=True,
        corrected=("gradient",),
        read=lambda stop, wheelsets, definition: _initial_adhesion(stop, definition),
        decided=ShownWhen(
            how="span",
            plot="deceleration",
            span=lambda stop, definition: (
                stop.sliding_time,
                stop.sliding_time + definition["first_phase_duration"],
            ),
            level=True,
            word="mean",
            span_name="first phase",
        ),
        definitions=("first_phase_duration",),
        observed_by=("sliding_slide", "sliding_slip", "moving_speed"),
        recorded=RecordedData(("speed", "wheel_speed_{n}"), bounded=False),
        column=StopColumn(
            "initial_adhesion_g",
            "g",
            meaning="initial adhesion by the first phase of the first criterion that defines one, else 3 s",
            overview=Overview("initial adhesion\ng", digits=4, rank=7, short="adhesion\ng", few_digits=3),
            read=lambda stop, definition: next(iter(_initial_adhesion(stop, definition).values), math.nan),
            defaults={"first_phase_duration": _DEFAULT_FIRST_PHASE},
        ),
    ),
    Measure(
        name="adhesion_utilisation",
        kind="share",
        course="settles",
        better="larger",
        meaning="work of the rail on the wheelsets over that at the maximum of their creep curves, of each"
        " while it slides or, once it has slid, its WSP holds its pressure down",
        of_standstill=True,
        read=lambda stop, wheelsets, definition: utilisation_of_train(stop),
        decided=_LIMITED_BY_RAIL,
        observed_by=_OF_UTILISATION,
        recorded=_CONTACTS,
        column=StopColumn(
            "adhesion_utilisation",
            "1",
            meaning="adhesion utilisation of the train as a share",
            read=lambda stop, definition: stop.adhesion_utilisation if stop.stopped else math.nan,
        ),
    ),
    Measure(
        name="wheelset_adhesion_utilisation",
        kind="share",
        course="settles",
        better="larger",
        meaning="adhesion utilisation of the wheelset; 100 % if it never slid where another one did",
        of_standstill=True,
        field="adhesion_utilisation",
        read=lambda stop, wheelsets, definition: utilisation_of_wheelsets(stop, wheelsets),
        decided=_LIMITED_BY_RAIL,
        of_wheelsets=True,
        observed_by=_OF_UTILISATION,
        recorded=_CONTACTS,
        column=WheelsetColumn(
            "adhesion_utilisation",
            "1",
            meaning="adhesion utilisation of the wheelset as a share, none if it never slid",
        ),
    ),
    Measure(
        name="minimum_deceleration",
        kind="acceleration",
        course="falls",
        better="larger",
        meaning="smallest filtered deceleration under developed braking",
        of_braking=True,
        absent=_NEVER_DEVELOPED,
        decided=ShownWhen(how="extreme", plot="deceleration", field="minimum_deceleration", level=True),
        observed_by=(*_FILTERING, "developed_time"),
        recorded=RecordedData(("speed",), bounded=False),  # the filter has to settle first
        column=StopColumn("minimum_deceleration_mps2", "m/s2"),
    ),
    Measure(
        name="maximum_deceleration",
        kind="acceleration",
        course="grows",
        meaning="largest filtered deceleration while the train runs",
        of_braking=True,
        absent=_NEVER_DEVELOPED,
        decided=ShownWhen(how="extreme", plot="deceleration", field="maximum_deceleration", level=True),
        observed_by=_FILTERING,
        recorded=RecordedData(("speed",)),
        column=StopColumn("maximum_deceleration_mps2", "m/s2"),
    ),
    *map(_of_bogie, _POSITIONS),
)
