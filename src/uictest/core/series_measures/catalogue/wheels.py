"""What wears flats into the wheels: locked time, slid distance, contact energy of the worst wheelset."""

from __future__ import annotations

from uictest.core.series_measures.measure import largest_of_wheelsets, median_and_worst

MEASURES = (
    *median_and_worst(
        "locked_time",
        "time",
        "s",
        "time the most locked wheelset is locked in all",
        largest_of_wheelsets("locked_time_s"),
    ),
    *median_and_worst(
        "slid_distance",
        "length",
        "m",
        "distance that the wheelset which slides farthest slides",
        largest_of_wheelsets("slid_distance_m"),
    ),
    *median_and_worst(
        "contact_energy",
        "energy",
        "kJ",
        "largest contact energy of a wheelset",
        largest_of_wheelsets("contact_energy_kj"),
    ),
)
