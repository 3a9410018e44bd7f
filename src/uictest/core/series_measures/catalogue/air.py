"""The air that wheel slide protection takes."""

from __future__ import annotations

from uictest.core.series_measures.measure import median_and_worst, of_stop

MEASURES = (
    *median_and_worst(
        "reservoir_margin",
        "pressure",
        "bar",
        "least pressure of the reservoir over the cylinders",
        of_stop("reservoir_margin_bar"),
        worse="smaller",
    ),
    *median_and_worst(
        "air_consumed", "normal volume", "NL", "air taken from the reservoir", of_stop("air_consumed_nl")
    ),
)
