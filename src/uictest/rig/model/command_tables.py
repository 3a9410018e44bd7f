"""The course of a stop in the parameter record: brake commands over time, a held speed, where it ends."""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.core.physics import MOST_COMMANDS
from uictest.core.record import Record, derived

CommandTable = Annotated[MutableSequence[float], MOST_COMMANDS]


class CommandTables(Record):
    """Fields of the parameter record that say what happens when."""

    # all commands, the first included, by when they take effect: rig.model.brake_command
    first_command: float = derived()  # share of full service
    command_count: int = derived()
    command_given: CommandTable = derived()  # when each is given, s
    command_shares: CommandTable = derived()  # of full service
    command_times: CommandTable = derived()  # when each takes effect, s
    command_pressures: CommandTable = derived()  # gauge, Pa
    command_rates: CommandTable = derived()  # with which pressure then rises, Pa/s
    release_rates: CommandTable = derived()  # with which it falls, Pa/s
    drag_duration: float = derived()  # for which traction holds drag_speed, s; 0: it does not
    drag_speed: float = derived()  # m/s
    end_speed: float = derived()  # at which the stop ends, m/s; 0: at standstill
