"""State of the rig: car, bogies, wheelsets, and the couplers between cars.

SI units; pressures are absolute unless named gauge. The order of fields carries no meaning.
"""

from uictest.controllers import CONTROLLERS, BrakedTrain, BrakedWheelset
from uictest.core.record import Record, layout_of
from uictest.rig.model.parameters import WheelsetParameters


class Frame(Record):
    """Motion of a rigid frame in the plane, and the forces summed on it."""

    position: float  # m
    speed: float  # m/s
    height: float  # above the position at rest, m
    vertical_speed: float  # m/s
    pitch: float  # rad
    pitch_rate: float  # rad/s
    pitch_change: float  # of the pitch rate within the last step, rad/s
    longitudinal_force: float  # N
    vertical_force: float  # N
    moment: float  # N m


class Car(Frame, BrakedTrain):
    """State of the car body, the air supply and the ledgers."""

    steps: float  # done so far by the brake, which may be ahead within a controller cycle
    vehicle_steps: float  # done so far by the vehicle
    substep: float  # of the brake within the controller cycle
    cycle: int  # of the controller, begun so far
    controller_failed: int  # 1 once the controller cannot go on: the stop ends
    diagnosis: int  # bits of a controller from outside
    time: float  # steps x step, never accumulated
    # air
    reservoir_mass: float
    reservoir_pressure: float
    compressor_running: float
    line_pressure: float
    line_mass: float
    line_temperature: float
    line_coldness: float  # physics.coldness of its air
    line_pressure_error: float  # momentary noise of its sensor, Pa
    demanded_pressure: float  # of the friction brake at present, gauge, Pa
    command_pressure: float  # that the command alone would demand, gauge, Pa
    command_place: int  # of the command in effect, from 0
    demand_start: float  # this and the next three: its ramp, physics.demanded_pressure
    demand_change: float  # Pa
    demand_begins: float  # s
    demand_rate: float  # 1/s
    blended_share: float  # of the demanded pressure above zero force that is taken off for it
    held_excess: float  # physics.held_excess of the brake line, Pa
    relieved: float  # 1 while the friction brake gives more than is wanted, and until it gives less
    dynamic_dropped: float  # 1 once a controller that cannot reduce it has acted
    dynamic_failed: float  # 1 while it has a fault
    line_saturated_steps: float  # in which its sensor was read and limited by its range
    # track brake: rig.model.track_brake
    track_brake_asked: float  # 1 while it is commanded or requested
    track_brake_due: float  # when the magnets are drawn to the rail then, s
    track_brake_failed: float  # 1 while it has a fault
    kept_track_request: int  # the last that reached it
    magnet_share: float  # of the whole attraction at present
    track_brake_force: float  # of all magnets against the motion, N
    track_brake_energy: float  # that it has turned into heat, J
    track_brake_time: float  # for which it has acted, s
    # ledgers
    compressor_air: float  # delivered, kg
    consumed_air: float  # taken from the reservoir, kg
    exhausted_air: float  # let out by the relay valve, kg
    supplied_enthalpy: float  # of the air taken from the reservoir, J
    exhausted_enthalpy: float  # of the air let out by the relay valve, J
    leaked_air: float  # from the brake line, kg
    leaked_enthalpy: float  # J
    line_heat: float  # from the wall of the brake line to its air, J
    damper_loss: float  # J
    resistance_loss: float  # J
    initial_energy: float  # J
    initial_air: float  # kg
    initial_air_energy: float  # of the air in the brake line and the tanks, J
    # faults: rig.model.faults, one bit for each of the list
    begun_faults: int
    ended_faults: int
    active_faults: int
    silent_cycles: int  # for which no command of the controller has reached the valves
    line_leak: float  # conductance of the leaks of the brake line, m3/(s Pa)
    # sanders: rig.model.sand
    wsp_acting_cycles: int  # for which it has held or vented a wheelset of the car without a break
    wsp_resting_cycles: int  # since it last did
    # second source of speed, accelerometer: rig.model.cycle
    train_speed_1: float  # its newest value, m/s
    train_speed_2: float  # the ones before
    train_speed_3: float
    train_speed_4: float
    held_train_speed: float  # that the controller was given last, m/s
    speed_before: float  # of the car one controller cycle ago, m/s
    # drag braking: rig.model.running_gear
    drag_phase: int
    drag_ends: float  # s
    holds_speed: float  # 1 while traction holds the speed
    held_time: float  # for which it has been held, s
    traction_work: float  # J
    # couplers: rig.model.train; zero in a car alone
    coupler_force: float  # of both ends, N
    coupler_moment: float  # N m
    coupler_work: float  # on the car, J
    # standstill, interpolated within the step
    stopped: float
    stop_time: float
    stop_position: float
    closed: float  # 1 once its measures are complete, in a train


class Bogie(Frame):
    """State of one bogie frame; two of them."""

    ahead: float  # of the car body's centre, m
    magnet_force: float  # of its magnets, along the motion, N
    magnet_moment: float  # N m
    magnet_speed: float  # of where they drag it, at the beginning of the step, m/s


class Wheelset(BrakedWheelset, WheelsetParameters):
    """State of one wheelset and its module; four of them, numbered from the leading end."""

    has_caliper: float  # 1 when its module has a real caliper, 0 when it is a tank
    ahead: float  # of its bogie's centre, m
    behind: float  # the leading wheelset, m
    # valve
    command_register: int  # the commands before the newest
    filling_cycles: int  # since the last command other than fill
    fill_before: float  # target openings before and after the switching instant of this cycle
    fill_after: float
    vent_before: float
    vent_after: float
    fill_opening: float
    vent_opening: float
    venting: float  # 1 while the newest command is to vent
    wsp_acting: float
    # air
    pressure: float
    air_mass: float
    air_temperature: float
    air_coldness: float  # physics.coldness
    vented_air: float
    vented_enthalpy: float  # J
    wall_heat: float  # from the wall of the tank, and the balls in it, to its air, J
    piston_work: float  # of the air on the piston, J
    # caliper
    stroke: float
    stroke_change: float
    caliper_force: float
    # compensation
    pressure_reading: float  # of the module's sensor, gauge, Pa
    memory_1: float
    memory_2: float
    memory_3: float
    wsp_share: float
    compensated_pressure: float  # gauge, after the cylinder dynamics or the modelled air
    # compensation by modelled air: physics.air, pressures and amounts of air in Pa
    modelled_tank_pressure: float
    modelled_tank_air: float
    modelled_pressure: float
    modelled_air: float
    modelled_travel: float  # of the piston, 0 to 1
    modelled_volume: float  # over that of a tank
    modelled_growth: float  # of that volume within the last step
    pressure_ratio: float  # modelled pressure over that of the tank, absolute
    computed_force: float
    # speed sensor that counts teeth, rig.model.cycle
    last_tooth: float  # that it saw, in pitches since the brake command
    tooth_time: float  # when the last of them passed, s
    tooth_rate: float  # teeth per s at the last reading
    tooth_speed: float  # of the last whole teeth, m/s
    # faults: rig.model.faults
    faulty: float  # 1 once one of its parts has had a fault
    report_required: float  # 1 once it has had one of a kind that is to be reported
    speed_sensor_faulty: float  # 1 while its speed sensor has one
    speed_held: float  # 1 while that is stuck
    held_speed: float  # its last reading, m/s
    pressure_held: float  # 1 while its pressure sensor is stuck
    held_pressure: float  # the last reading of that, gauge, Pa
    shown_pressure: float  # to the controller, gauge, Pa
    kept_command: int  # the last that reached the valve
    kept_reduction: float  # the last that reached the motor
    kept_request: int  # the last that reached the sander
    tank_leak: float  # conductance of its leaks, m3/(s Pa)
    leaked_air: float  # kg
    leaked_enthalpy: float  # J
    # sensors, held for a controller cycle
    pressure_error: float  # momentary noise, Pa
    loadcell_error: float  # N
    pressure_saturated_steps: float  # in which its pressure sensor was limited by its range
    loadcell_saturated_steps: float  # in which the loadcells of its caliper were
    # brake and rail
    clamping_force: float  # as the vehicle simulation receives it
    torque: float  # largest of all brakes together, N m
    dynamic_torque: float  # part of it, N m
    motor_force: float  # largest force of the dynamic brake at the rims, N
    motor_power: float  # W
    motor_effort: float  # share of what the motor could give at present
    pad_friction: float  # held for a controller cycle
    disc_temperature: float  # of the discs' bulk, K
    disc_surface_temperature: float  # K
    disc_mode_1: float  # modes of the temperature across the ring, at the surface, K
    disc_mode_2: float
    disc_mode_3: float
    disc_mode_4: float
    disc_mode_5: float
    disc_mode_6: float
    friction: float
    friction_ratio: float  # this and the next three: shape of the creep curve of the rail under it
    friction_decay: float  # s/m
    reduction_adhesion: float
    reduction_slip: float
    cleaned_share: float  # of the rail under the wheelset and behind it
    # sander, and sand on the rail: rig.model.sand
    slides_by_wsp: float  # 1 while the WSP says so to the sander
    sander_open: float  # 1 while it is to lay sand
    sander_lag: int  # controller cycles for which the demand has been another
    sander_blocked: float  # 1 while it has that fault
    sand_density: float  # on the rail before the wheelset, kg/m
    sand_laid: float  # kg
    sand_in_window: float  # most in any time of sand.SAND_WINDOW, kg
    sanding_time: float  # for which it lays sand without a break at present, s
    longest_sanding: float  # s
    wheel_load: float
    contact_stiffness: float
    creep_force: float  # of both wheels, against the motion
    # motion
    position: float
    speed: float
    rotation: float
    angle: float  # turned since the brake command, rad
    # ledgers
    brake_heat: float  # of the friction brake, J
    dynamic_energy: float  # taken by the dynamic brake, J
    contact_loss: float  # J
    disc_heat: float  # of brake_heat, what has warmed the modelled discs, J
    disc_cooling: float  # from the discs to the air, J
    # friction that varies at random: rig.model.rail
    rail_point: float  # the last that it has passed, counted from far behind
    rail_deviation: float  # of the logarithm of friction at the next point, over its spread
    rail_factor: float  # of friction at the last point
    next_rail_factor: float


class ModuleStep(Record):
    """What is kept of one module in one step while the brake runs ahead of the vehicle."""

    pressure_reading: float  # as in :class:`Wheelset`
    pressure_ratio: float
    clamping_force: float


class Coupler(Record):
    """The coupler after a car: its numbers, its state and its ledgers."""

    stiffness: float  # N/m
    damping: float  # N s/m
    height: float  # above the rail, m
    force: float  # with which it pulls both cars together, N
    leading_speed: float  # of its point on the car before it at the beginning of the step, m/s
    trailing_speed: float  # and on the car behind it
    loss: float  # J
    largest_pull: float  # N
    largest_push: float  # N


CAR = layout_of(Car, *(controller.train_memory for controller in CONTROLLERS.values()))
"""Layout of :class:`Car` and of what every controller remembers about the train."""
BOGIE = layout_of(Bogie)
"""Layout of :class:`Bogie`."""
WHEELSET = layout_of(Wheelset, *(controller.wheelset_memory for controller in CONTROLLERS.values()))
"""Layout of :class:`Wheelset` and of what every controller remembers about a wheelset."""
MODULE_STEP = layout_of(ModuleStep)
"""Layout of :class:`ModuleStep`."""
COUPLER = layout_of(Coupler)
"""Layout of :class:`Coupler`."""
