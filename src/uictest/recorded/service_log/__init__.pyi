from .clocks import clock_text as clock_text
from .finder import (
    FinderSettings as FinderSettings,
    Log as Log,
    LoggedEvent as LoggedEvent,
    find_stops as find_stops,
)
from .signals import SHOWN_BY as SHOWN_BY
from .stretches import write_stops as write_stops
