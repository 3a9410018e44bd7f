from .course import clock_text as clock_text
from .signals import SHOWN_BY as SHOWN_BY
from .stops import (
    FinderSettings as FinderSettings,
    Log as Log,
    LoggedEvent as LoggedEvent,
    find_stops as find_stops,
    write_stops as write_stops,
)
