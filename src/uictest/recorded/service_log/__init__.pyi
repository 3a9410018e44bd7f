from .clocks import EARLIEST_DATE as EARLIEST_DATE
from .finder import (
    FinderSettings as FinderSettings,
    Log as Log,
    LoggedEvent as LoggedEvent,
    find_stops as find_stops,
)
from .rail_use import RailUse as RailUse, RailWindows as RailWindows, rail_use as rail_use
from .signals import SHOWN_BY as SHOWN_BY
from .stretches import write_stops as write_stops
from .wheelset_signs import (
    SIGNS as SIGNS,
    SignKind as SignKind,
    WheelsetSigns as WheelsetSigns,
    wheelset_signs as wheelset_signs,
)
