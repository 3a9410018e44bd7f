"""Units for what recordings and results hold: `recording["speed"] / units.KILOMETRE_PER_HOUR` is in km/h."""

from uictest.core.units import (
    BAR as BAR,
    KILOMETRE_PER_HOUR as KILOMETRE_PER_HOUR,
    KILONEWTON as KILONEWTON,
    KILONEWTON_PER_BAR as KILONEWTON_PER_BAR,
    PERCENT as PERCENT,
    in_unit as in_unit,
)
