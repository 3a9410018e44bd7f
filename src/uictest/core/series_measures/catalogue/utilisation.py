"""How much of the adhesion that the rail offers is used."""

from __future__ import annotations

from uictest.core.series_measures.measure import CountedStop, median_and_worst


def adhesion_utilisation(stop: CountedStop) -> float:
    """Return work done by the rail over work available at the friction maximum, %, for the train."""
    return 100.0 * stop.measures.get("adhesion_utilisation", float("nan"))


MEASURES = (
    *median_and_worst(
        "adhesion_utilisation",
        "share",
        "%",
        "work done by the rail over work available at the friction maximum",
        adhesion_utilisation,
        worse="smaller",
    ),
)
