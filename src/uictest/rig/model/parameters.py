"""Parameters: the numbers that a case fixes, each declared once; those of a wheelset stand apart.

:func:`~uictest.core.record.from_scenario` names the key of the scenario whose value the field holds, for a
wheelset as :func:`uictest.plans.scenario.wheelset_value` does; every other field is computed by
:mod:`uictest.rig.assembly` and the assemblies of its room. Tables are read by scalar code alone.
SI units; pressures are absolute unless named gauge. The order of fields carries no meaning.
"""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.controllers import CONTROLLERS, ControllerCycle
from uictest.core.measures import MeasureDefinition
from uictest.core.physics import MOST_COMMANDS, MOST_PAD_POINTS, MOST_SAND_POINTS
from uictest.core.rail_laws import MOST_NUMBERS
from uictest.core.record import FieldCopier, Record, from_scenario, layout_of
from uictest.plans.faults import MOST_FAULTS

CommandTable = Annotated[MutableSequence[float], MOST_COMMANDS]


class CommandTables(Record):
    """Fields of the parameter record that say what happens when."""

    # all commands, the first included, by when they take effect: rig.model.pneumatics
    first_command: float  # share of full service
    command_count: int
    command_given: CommandTable  # when each is given, s
    command_shares: CommandTable  # of full service
    command_times: CommandTable  # when each takes effect, s
    command_pressures: CommandTable  # gauge, Pa
    command_rates: CommandTable  # with which pressure then rises, Pa/s
    release_rates: CommandTable  # with which it falls, Pa/s
    drag_duration: float  # for which traction holds drag_speed, s; 0: it does not
    drag_speed: float  # m/s
    end_speed: float  # at which the stop ends, m/s; 0: at standstill


FaultTable = Annotated[MutableSequence[float], MOST_FAULTS]


class FaultTables(Record):
    """The faults of a stop, in the order of the scenario; effects as in :class:`.Effects`."""

    fault_count: int
    has_leaks: float  # 0 or 1: a fault is a leak
    # it begins once all of these hold, and ends once the second three do
    fault_begin_time: FaultTable  # time since the command of at least, s
    fault_begin_speed: FaultTable  # train speed of at most, m/s
    fault_begin_distance: FaultTable  # distance since the command of at least, m
    fault_end_time: FaultTable
    fault_end_speed: FaultTable
    fault_end_distance: FaultTable
    # whose it is
    fault_wheelset: FaultTable  # 0 to 3
    fault_of_wheelset: FaultTable  # 0 where it is one of the train
    fault_of_speed_sensor: FaultTable  # 0 or 1
    fault_report_required: FaultTable  # 0 or 1
    # what it changes
    fault_speed_valid: FaultTable
    fault_speed_held: FaultTable
    fault_speed_factor: FaultTable
    fault_speed_offset: FaultTable  # m/s
    fault_speed_jump: FaultTable  # m/s
    fault_drop_out: FaultTable
    fault_lost_teeth: FaultTable
    fault_fill_at_least: FaultTable
    fault_fill_at_most: FaultTable
    fault_vent_at_least: FaultTable
    fault_vent_at_most: FaultTable
    fault_travel_per_step: FaultTable  # largest change of an opening in a step
    fault_tank_leak: FaultTable  # m3/(s Pa)
    fault_line_leak: FaultTable  # m3/(s Pa)
    fault_pressure_held: FaultTable
    fault_pressure_factor: FaultTable
    fault_pressure_offset: FaultTable  # Pa
    fault_silent: FaultTable
    fault_dynamic_failed: FaultTable  # 0 or 1
    fault_track_failed: FaultTable  # 0 or 1
    fault_sander_blocked: FaultTable  # 0 or 1
    fault_train_speed_valid: FaultTable
    fault_train_speed_held: FaultTable
    fault_train_speed_factor: FaultTable
    fault_train_speed_offset: FaultTable  # m/s
    fault_release_cycles: FaultTable  # controller cycles of silence after which the valves fill


SanderTable = Annotated[MutableSequence[float], 4]
"""A number for the sander of each wheelset; zero where there is none."""
SandTable = Annotated[MutableSequence[float], MOST_SAND_POINTS]


class SandTables(Record):
    """Fields of the parameter record that :mod:`uictest.rig.model.sand` reads; all zero without sanders."""

    has_sanders: float  # 0 or 1; in a train 1 in every car if one has a sander
    sander_rates: SanderTable  # largest, kg/s
    sander_densities: SanderTable  # largest, kg/m; infinite: the rate alone counts
    sander_distances: SanderTable  # of the nozzle ahead of the wheelset, m
    sander_delays: SanderTable  # controller cycles from the demand to sand on the rail
    sander_off_speeds: SanderTable  # train speed below which none is demanded, m/s
    # what demands sand: 0 or 1
    sanders_always: SanderTable
    sanders_on_slide: SanderTable
    sanders_on_request: SanderTable
    sander_slide_cycles: SanderTable  # of a WSP that acts, after which wheels slide
    sander_run_on_cycles: SanderTable  # of a WSP that rests, after which they do no more
    # on the rail
    sand_points_per_metre: float  # grid, 1/m
    sand_kept: float  # share that a wheelset leaves
    sand_friction: float  # initial friction coefficient with enough sand
    sand_points: int  # of the table
    sand_densities: SandTable  # kg/m
    sand_shares: SandTable  # of the way to the friction with enough sand


class TrackBrakeNumbers(Record):
    """What a case fixes of the track brake: :mod:`uictest.core.physics.brakes`."""

    has_track_brake: float  # 0 or 1
    magnet_attraction: float  # of the magnets of one bogie together, N
    magnet_friction: float  # at high speed
    magnet_numerator: float  # m/s
    magnet_denominator: float  # m/s
    magnet_slowest: float  # speed below which friction goes to zero, m/s
    magnet_cleaning: float  # share of the work that cleans the rail
    magnet_change: float  # largest change of the share of the attraction in a controller cycle
    track_brake_commands: CommandTable  # 1 for each command with which it may act
    track_brake_first: float  # when the first command is given, s
    track_brake_requested: float  # 1: only while the controller asks for it
    track_brake_delay: float  # from command or request until the attraction rises, s
    track_brake_off_speed: float  # at and below which it is off, m/s; 0: never


class TrainSensor(Record):
    """What a case fixes of them: :mod:`uictest.rig.model.cycle`."""

    has_train_speed: float  # 0 or 1; where 0, the next four are zero
    train_speed_period: int  # controller cycles
    train_speed_delay: int  # controller cycles
    train_speed_noise: float  # m/s
    train_speed_gain_error: float
    has_accelerometer: float  # 0 or 1; where 0, the next two are zero
    accelerometer_noise: float  # m/s2
    accelerometer_offset: float  # m/s2


PadTable = Annotated[MutableSequence[float], MOST_PAD_POINTS]
MotorTable = Annotated[MutableSequence[float], 4]
LawNumbers = Annotated[MutableSequence[float], MOST_NUMBERS]


def inverse(value: float) -> float:
    """Return 1 / ``value``: the step multiplies, since a division takes as long as dozens of products."""
    return 1.0 / value


def of_both_sides(value: float) -> float:
    """Return the sum over the two axle boxes of a wheelset or the two sides of a bogie."""
    return 2.0 * value


class Parameters(
    ControllerCycle, MeasureDefinition, FaultTables, CommandTables, TrackBrakeNumbers, SandTables, TrainSensor
):
    """What a case fixes for all wheelsets, but for the parameters of its controller."""

    # time
    step: float = from_scenario("simulation.time_step")  # base step, s
    steps_per_cycle: int
    cycles: int  # longest stop, in controller cycles
    # keys of the noise
    seed: int = from_scenario("seed")
    noise_key: int  # rig.train_stop
    # command and topology
    initial_speed: float = from_scenario("initial_speed")  # m/s
    calipers: int  # modules with a real caliper: 1 or 4
    uses_cylinder_dynamics: float  # 0 or 1, in modules without a caliper
    uses_module_air: float  # 0 or 1, in modules without a caliper
    uses_hysteresis: float  # 0 or 1, in modules without a caliper
    wsp_active: int  # 0: the valves always fill
    demand_per_pressure: float  # share of full service per demanded pressure, 1/Pa
    controller: int  # number of rig.model.controller.CHOICES
    controller_contract: int  # version that it keeps; from outside: said where it is opened
    # a controller from outside: addresses, set where it is opened
    controller_step: int
    controller_handle: int
    controller_exchange: int
    # dynamic brake: physics.brakes; all zero without one
    has_dynamic_brake: float  # 0 or 1
    motor_forces: MotorTable  # of each wheelset, N
    motor_powers: MotorTable  # W
    motor_response: float  # share of the missing effort that a motor gains in a controller cycle
    fade_end: float  # m/s
    fade_rate: float  # s/m
    zero_force_pressure: float  # gauge, Pa
    force_per_pressure: float  # of the car at the rims above that, N/Pa
    coulomb_width: float  # of the loop of the caliper without load, Pa
    load_width: float  # what it gains per pressure above zero_force_pressure
    # brake operating unit, reservoir, compressor, brake line
    commanded_pressure: float  # demanded once the brake is fully applied, gauge, Pa
    dead_time: float  # from the command to the first demand, s
    filling_rate: float  # share of the commanded pressure per second
    relay_conductance: float = from_scenario("brake.system.relay_valve.conductance")  # m3/(s Pa)
    relay_gain: float = from_scenario(
        "brake.system.relay_valve.proportional_band", inverse
    )  # opening per missing Pa
    line_volume: float = from_scenario("brake.system.brake_line.volume")  # m3
    line_exchange: float  # heat conductance to its wall times the step, J/K
    reservoir_volume: float = from_scenario("brake.system.reservoir.volume")  # m3
    reservoir_stiffness: float  # pressure per mass of air, Pa/kg
    reservoir_pressure: float  # at the start, Pa
    compressor_cut_in: float  # Pa
    compressor_cut_out: float  # Pa
    compressor_delivery: float  # kg/s
    # air and orifices
    atmospheric_pressure: float = from_scenario("brake.system.air.atmospheric_pressure")  # Pa
    gas_constant: float = from_scenario("brake.system.air.gas_constant")  # J/(kg K)
    air_temperature: float = from_scenario("brake.system.air.temperature")  # K
    heat_capacity_ratio: float = from_scenario("brake.system.air.heat_capacity_ratio")
    heat_capacity_pressure: float  # at constant pressure, J/(kg K)
    heat_capacity_volume: float  # at constant volume, J/(kg K)
    air_coldness: float  # physics.coldness of the surroundings
    critical_ratio: float  # this and the next two: physics.orifice_law
    subsonic_scale: float
    laminar_slope: float
    # tanks
    tank_volume: float = from_scenario("brake.system.tank.volume")  # module without a caliper, m3
    tank_exchange: float  # heat conductance to its wall times the step, J/K
    caliper_tank_volume: float  # module with a caliper, piston at rest, m3
    caliper_tank_exchange: float  # heat conductance to its wall and balls times the step, J/K
    # caliper
    piston_area: float = from_scenario("rig.caliper.piston_area")  # m2
    preload: float = from_scenario("rig.caliper.preload")  # N
    clearance: float = from_scenario("rig.caliper.clearance")  # m
    piston_damping: float  # this and the next two: physics.caliper.stiffnesses
    contact_damping: float
    free_compliance: float
    contact_stiffness: float = from_scenario("rig.caliper.contact_stiffness")  # N/m
    lever_ratio: float = from_scenario("rig.caliper.lever_ratio")
    # compensation: coefficients of the cylinder's transfer function at this step
    b0: float
    b1: float
    b2: float
    b3: float
    a1: float
    a2: float
    a3: float
    # compensation: modelled air of the caliper's module, physics.air
    modelled_tank_exchange: float  # Pa
    modelled_exchange: float  # Pa
    modelled_fill_conductance: float  # air in a step over the reduced flow
    modelled_vent_conductance: float
    modelled_swept_share: float  # of a tank's volume
    modelled_closing_pressure: float  # Pa
    modelled_opening_pressure: float  # Pa
    # compensation: lines of force over pressure, N/Pa and N
    linear_slope: float = from_scenario("rig.compensation_model.linear.slope")
    linear_intercept: float = from_scenario("rig.compensation_model.linear.intercept")
    bc_squeezing_slope: float = from_scenario("rig.compensation_model.hysteresis.bc_squeezing.slope")
    bc_squeezing_intercept: float = from_scenario("rig.compensation_model.hysteresis.bc_squeezing.intercept")
    bc_releasing_slope: float = from_scenario("rig.compensation_model.hysteresis.bc_releasing.slope")
    bc_releasing_intercept: float = from_scenario("rig.compensation_model.hysteresis.bc_releasing.intercept")
    wsp_squeezing_slope: float = from_scenario("rig.compensation_model.hysteresis.wsp_squeezing.slope")
    wsp_squeezing_intercept: float = from_scenario(
        "rig.compensation_model.hysteresis.wsp_squeezing.intercept"
    )
    wsp_releasing_slope: float = from_scenario("rig.compensation_model.hysteresis.wsp_releasing.slope")
    wsp_releasing_intercept: float = from_scenario(
        "rig.compensation_model.hysteresis.wsp_releasing.intercept"
    )
    phase_change_per_step: float  # share of the way between the two pairs of lines
    wsp_acting_cycles: int  # cycles of filling after which the WSP no longer counts as acting
    # compensation: how far the rig is from the one it was identified for, over the tolerance; NaN: not known
    compensation_misfit: float
    # disc brake
    calipers_per_wheelset: float = from_scenario("brake.system.disc.calipers_per_wheelset")
    pads_per_caliper: float = from_scenario("brake.system.disc.pads_per_caliper")
    disc_radius: float = from_scenario("brake.system.disc.mean_radius")  # m
    # factors of the pad friction over m/s, N and K: tables, and physics.quotient_factor
    varies_pad_friction: float  # 0 or 1
    pad_speeds: PadTable
    pad_speed_factors: PadTable
    pad_speed_points: int
    pad_speed_numerator: float
    pad_speed_denominator: float
    pad_speed_scale: float
    pad_forces: PadTable
    pad_force_factors: PadTable
    pad_force_points: int
    pad_force_numerator: float
    pad_force_denominator: float
    pad_force_scale: float
    pad_temperatures: PadTable
    pad_temperature_factors: PadTable
    pad_temperature_points: int
    # temperature of the discs of a wheelset in a controller cycle: physics.brakes
    models_disc_temperature: float  # 0 or 1; where 0, all of the following but one are zero
    initial_disc_temperature: float  # K
    disc_heat_capacity: float  # J/K
    disc_warming: float  # of the bulk, K/J
    disc_relaxation: float  # of the bulk to the air's temperature, share
    disc_held_rise: float  # of the modes that are not followed, K/J
    disc_rise_1: float  # of the modes of the temperature profile, K/J
    disc_rise_2: float
    disc_rise_3: float
    disc_rise_4: float
    disc_rise_5: float
    disc_rise_6: float
    disc_relaxation_1: float  # of these modes, share
    disc_relaxation_2: float
    disc_relaxation_3: float
    disc_relaxation_4: float
    disc_relaxation_5: float
    disc_relaxation_6: float
    # car body and bogies
    body_mass: float  # with its load, kg
    body_inertia: float  # kg m2
    body_mass_rate: float  # mass over step, kg/s
    body_mass_response: float  # step over mass, s/kg
    body_pitch_response: float  # step over inertia, s/(kg m2)
    body_height: float = from_scenario("vehicle.body.height")  # m
    bogie_mass: float = from_scenario("vehicle.bogie.mass")  # kg
    bogie_inertia: float = from_scenario("vehicle.bogie.pitch_inertia")  # kg m2
    bogie_mass_response: float  # s/kg
    bogie_pitch_response: float  # s/(kg m2)
    bogie_height: float = from_scenario("vehicle.bogie.height")  # m
    half_wheelbase: float = from_scenario("vehicle.bogie.half_wheelbase")  # m
    half_pivot_distance: float = from_scenario("vehicle.half_pivot_distance")  # m
    # wheelset
    wheelset_mass: float = from_scenario("vehicle.wheelset.mass")  # kg
    mass_response: float  # step over wheelset mass, s/kg
    # suspensions: primary per wheelset, secondary per bogie, N/m and N s/m
    primary_longitudinal_stiffness: float = from_scenario(
        "vehicle.primary.longitudinal_stiffness", of_both_sides
    )
    primary_longitudinal_damping: float = from_scenario("vehicle.primary.longitudinal_damping", of_both_sides)
    primary_vertical_stiffness: float = from_scenario("vehicle.primary.vertical_stiffness", of_both_sides)
    primary_vertical_damping: float = from_scenario("vehicle.primary.vertical_damping", of_both_sides)
    secondary_longitudinal_stiffness: float = from_scenario(
        "vehicle.secondary.longitudinal_stiffness", of_both_sides
    )
    secondary_longitudinal_damping: float = from_scenario(
        "vehicle.secondary.longitudinal_damping", of_both_sides
    )
    secondary_vertical_stiffness: float = from_scenario("vehicle.secondary.vertical_stiffness", of_both_sides)
    secondary_vertical_damping: float = from_scenario("vehicle.secondary.vertical_damping", of_both_sides)
    secondary_height: float = from_scenario("vehicle.secondary.height")  # m
    link_stiffness: float = from_scenario("vehicle.traction_link.stiffness")  # per bogie
    link_damping: float = from_scenario("vehicle.traction_link.damping")
    link_height: float = from_scenario("vehicle.traction_link.height")  # m
    # running resistance and weight
    resistance_constant: float = from_scenario("vehicle.running_resistance.constant")  # N
    resistance_linear: float = from_scenario("vehicle.running_resistance.linear")  # N s/m
    resistance_quadratic: float = from_scenario("vehicle.running_resistance.quadratic")  # N s2/m2
    gravity: float  # m/s2
    total_mass: float  # of the car, kg
    static_wheel_load: float  # of one wheel, N
    # wheel and rail
    gradient: float = from_scenario("rail.gradient")  # positive uphill
    friction_ratio: float = from_scenario("rail.condition.friction_ratio")
    friction_decay: float = from_scenario("rail.condition.friction_decay")  # s/m
    reduction_adhesion: float = from_scenario("rail.condition.reduction_adhesion")
    reduction_slip: float = from_scenario("rail.condition.reduction_slip")
    creep_stiffness: float  # (1/4) G pi a b c11 at the reference load, N
    reference_load: float = from_scenario("rail.condition.contact.reference_wheel_load")  # N
    load_scale: float = from_scenario("rail.condition.contact.reference_wheel_load", inverse)  # 1/N
    # largest creep force: physics.rail
    highest_creep_scale: float  # s/m
    highest_creep_0: float
    highest_creep_1: float
    highest_creep_2: float
    highest_creep_3: float
    highest_creep_4: float
    highest_creep_5: float
    highest_creep_6: float
    highest_creep_7: float
    friction_points: int  # points of the friction along the track
    friction_times: int  # points of its factor over time
    # factor of the friction over the train's speed: physics.quotient_factor
    friction_speed_numerator: float  # m/s
    friction_speed_denominator: float  # m/s
    friction_speed_scale: float
    # friction that varies at random along the track: rig.model.rail
    varies_friction: float  # 0 or 1; where 0, all of the following are zero
    variation_points_per_metre: float
    variation_persistence: float  # correlation of two neighbouring points
    variation_renewal: float  # share of a point that its neighbour does not decide
    variation_log_spread: float
    # rail cleaned by sliding: physics.rail
    cleans_rail: float  # 0 or 1
    rail_law: int  # number of core.rail_laws.LAWS
    law_numbers: LawNumbers  # its own
    cleaning_response: float  # cleaned share per energy per metre of track, m/J
    cleaning_decay: float  # 1/m
    recovered_friction: float
    clean_friction_ratio: float  # this and the next three: of a clean rail
    clean_friction_decay: float  # s/m
    clean_reduction_adhesion: float
    clean_reduction_slip: float
    spent_share: float  # that earlier stops have cleaned
    clean_highest_creep_scale: float  # as highest_creep_*, of a clean rail
    clean_highest_creep_0: float
    clean_highest_creep_1: float
    clean_highest_creep_2: float
    clean_highest_creep_3: float
    clean_highest_creep_4: float
    clean_highest_creep_5: float
    clean_highest_creep_6: float
    clean_highest_creep_7: float
    carry_over: float
    rail_points_per_metre: float  # grid of rig.model.rail, 1/m
    uses_pole_wheels: float  # 0 or 1: a wheelset has a sensor that counts teeth
    # sensors: what all of a kind share, and the errors of the one of the brake line
    pressure_range: float = from_scenario("rig.sensors.pressure.range")  # Pa
    line_sensor_gain_error: float = from_scenario("rig.sensors.pressure.gain_error")
    line_sensor_offset: float = from_scenario("rig.sensors.pressure.offset")  # Pa
    line_sensor_noise: float = from_scenario("rig.sensors.pressure.noise")  # Pa
    pressure_resolution: float = from_scenario("rig.sensors.pressure.resolution")  # Pa
    pressure_steps: float = from_scenario("rig.sensors.pressure.resolution", inverse)  # per Pa
    loadcell_range: float = from_scenario("rig.sensors.loadcell.range")  # N
    loadcell_resolution: float = from_scenario("rig.sensors.loadcell.resolution")  # N
    loadcell_steps: float = from_scenario("rig.sensors.loadcell.resolution", inverse)  # per N


PARAMETERS = layout_of(Parameters, *(controller.parameters for controller in CONTROLLERS.values()))
"""Layout of :class:`Parameters` and of the parameters of every controller."""


class WheelsetParameters(Record):
    """What a case fixes for one wheelset, its brake and its sensors."""

    # wheel
    wheel_radius: float = from_scenario("wheel_radius")  # at which it rolls, m
    configured_radius: float = from_scenario("configured_radius")  # of which the WSP was told, m
    rotational_inertia: float = from_scenario("rotational_inertia")  # with what it drives, kg m2
    inertia_response: float  # step over that, s/(kg m2)
    inertia_stiffness: float  # its inverse
    slip_response: float  # change of slip speed in a step per creep force, m/(s N)
    slip_stiffness: float  # its inverse
    # disc brake
    brake_force: float = from_scenario("brake_force")  # share of the regular torque
    reference_pad_friction: float = from_scenario("pad_friction")  # where the factors of the pads are 1
    # caliper
    coulomb_friction: float = from_scenario("caliper.coulomb_friction")  # N
    squeezing_stiffness: float  # this and the next three: physics.caliper.stiffnesses
    releasing_stiffness: float
    squeezing_compliance: float
    releasing_compliance: float
    # WSP valve
    fill_conductance: float = from_scenario("wsp_valve.fill_conductance")  # m3/(s Pa)
    vent_conductance: float = from_scenario("wsp_valve.vent_conductance")  # m3/(s Pa)
    valve_travel_per_step: float  # share of full opening
    valve_delay_cycles: int  # whole controller cycles of the switching delay
    valve_delay_steps: float  # and the steps that remain of it
    # sensors
    tooth_pitch: float  # at the tread of a wheel of the configured radius, m
    timer_resolution: float = from_scenario("sensors.speed.timer_resolution")  # s
    slowest_measured_speed: float = from_scenario("sensors.speed.minimum_speed")  # m/s
    speed_noise: float = from_scenario("sensors.speed.noise")  # share of the reading
    speed_gain_error: float = from_scenario("sensors.speed.gain_error")
    counts_teeth: float  # 0 or 1: the speed is that of the last whole teeth
    teeth: float = from_scenario("sensors.speed.teeth")  # of the pole wheel, missing ones included
    missing_teeth: float = from_scenario("sensors.speed.missing_teeth")  # in one gap
    eccentricity: float = from_scenario("sensors.speed.eccentricity")  # relative error of the speed
    pressure_gain_error: float = from_scenario("sensors.pressure.gain_error")
    pressure_offset: float = from_scenario("sensors.pressure.offset")  # Pa
    pressure_noise: float = from_scenario("sensors.pressure.noise")  # Pa
    loadcell_gain_error: float = from_scenario("sensors.loadcell.gain_error")
    loadcell_offset: float = from_scenario("sensors.loadcell.offset")  # N
    loadcell_noise: float = from_scenario("sensors.loadcell.noise")  # N


WHEELSET_PARAMETERS = layout_of(WheelsetParameters)
"""Layout of :class:`WheelsetParameters`."""
copy_wheelset_parameters = FieldCopier(WheelsetParameters)
"""Set the parameters in the first of two records to those of the second."""
