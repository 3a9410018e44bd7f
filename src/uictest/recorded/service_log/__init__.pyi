from .clocks import EARLIEST_DATE as EARLIEST_DATE
from .command_course import (
    CommandCourse as CommandCourse,
    command_course as command_course,
    held_speed as held_speed,
    read_like as read_like,
)
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
