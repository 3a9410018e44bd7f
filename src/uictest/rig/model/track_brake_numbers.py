"""The magnetic track brake in the parameter record; without one no force, and no division by zero."""

from uictest.core.record import Record, derived
from uictest.rig.model.command_tables import CommandTable


class TrackBrakeNumbers(Record):
    """What a case fixes of the track brake: :mod:`uictest.core.physics.track_brake`."""

    has_track_brake: float = derived()  # 0 or 1
    magnet_attraction: float = derived()  # of the magnets of one bogie together, N
    magnet_friction: float = derived()  # at high speed
    magnet_numerator: float = derived()  # m/s
    magnet_denominator: float = derived()  # m/s
    magnet_slowest: float = derived()  # speed below which friction goes to zero, m/s
    magnet_cleaning: float = derived()  # share of the work that cleans the rail
    magnet_change: float = derived()  # largest change of the share of the attraction in a controller cycle
    track_brake_commands: CommandTable = derived()  # 1 for each command with which it may act
    track_brake_first: float = derived()  # when the first command is given, s
    track_brake_requested: float = derived()  # 1: only while the controller asks for it
    track_brake_delay: float = derived()  # from command or request until the attraction rises, s
    track_brake_off_speed: float = derived()  # at and below which it is off, m/s; 0: never
