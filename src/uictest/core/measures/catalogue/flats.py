"""What wears flats: how far the wheelsets slide, and the energy that their contacts turn into heat."""

from __future__ import annotations

from uictest.core.measures.measure import Decided, Measure, RecordedData, WheelsetColumn, value_per_wheelset

_OBSERVED_BY = ("sliding_slide", "sliding_slip", "moving_speed")

MEASURES = (
    Measure(
        name="slid_distance",
        kind="length",
        unit="m",
        course="grows",
        meaning="distance that the train runs while the wheelset slides or is locked",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.slid_distance for w in wheelsets),
        decided=Decided(how="intervals", plot="sliding", field="slid_distance"),
        of_wheelsets=True,
        observed_by=_OBSERVED_BY,
        recorded=RecordedData(("speed", "wheel_speed_{n}")),
        column=WheelsetColumn("slid_distance_m", "m", read=lambda wheelset: wheelset.slid_distance),
        finite_field="slid_distance",
    ),
    Measure(
        name="contact_energy",
        kind="energy",
        unit="kJ",
        course="grows",
        meaning="energy that both contacts of the wheelset turn into heat while it slides or is locked",
        read=lambda stop, wheelsets, definition: value_per_wheelset(w.contact_energy for w in wheelsets),
        decided=Decided(how="intervals", plot="sliding", field="contact_energy"),
        of_wheelsets=True,
        observed_by=_OBSERVED_BY,
        recorded=RecordedData(("speed", "wheel_speed_{n}", "adhesion_{n}", "wheel_load_{n}"), computed=True),
        column=WheelsetColumn("contact_energy_kj", "kJ", read=lambda wheelset: wheelset.contact_energy),
        finite_field="contact_energy",
    ),
)
