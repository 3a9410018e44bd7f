"""Parameters: the numbers that a case fixes, each declared once; those of a wheelset stand apart.

:func:`~uictest.core.record.from_scenario` names the key of the scenario whose value the field holds, for a
wheelset as :func:`uictest.plans.scenario.wheelset_value` does; what is :func:`~uictest.core.record.derived`
is computed by :mod:`uictest.rig.assembly` and the assemblies beside it. Tables are read by scalar code alone.
SI units; pressures are absolute unless named gauge. The order of fields carries no meaning.
"""

from collections.abc import MutableSequence
from typing import Annotated

from uictest.controllers import CONTROLLERS, ControllerCycle
from uictest.core.measures import MeasureDefinition
from uictest.core.physics import MOST_COMMANDS, MOST_PAD_POINTS, MOST_SAND_POINTS
from uictest.core.rail_laws import MOST_NUMBERS
from uictest.core.record import FieldCopier, Record, derived, from_scenario, layout_of
from uictest.plans.faults import MOST_FAULTS

CommandTable = Annotated[MutableSequence[float], MOST_COMMANDS]


class CommandTables(Record):
    """Fields of the parameter record that say what happens when."""

    # all commands, the first included, by when they take effect: rig.model.pneumatics
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


FaultTable = Annotated[MutableSequence[float], MOST_FAULTS]


class FaultTables(Record):
    """The faults of a stop, in the order of the scenario; effects as in :class:`.Effects`."""

    fault_count: int = derived()
    has_leaks: float = derived()  # 0 or 1: a fault is a leak
    # it begins once all of these hold, and ends once the second three do
    fault_begin_time: FaultTable = derived()  # time since the command of at least, s
    fault_begin_speed: FaultTable = derived()  # train speed of at most, m/s
    fault_begin_distance: FaultTable = derived()  # distance since the command of at least, m
    fault_end_time: FaultTable = derived()
    fault_end_speed: FaultTable = derived()
    fault_end_distance: FaultTable = derived()
    # whose it is
    fault_wheelset: FaultTable = derived()  # 0 to 3
    fault_of_wheelset: FaultTable = derived()  # 0 where it is one of the train
    fault_of_speed_sensor: FaultTable = derived()  # 0 or 1
    fault_report_required: FaultTable = derived()  # 0 or 1
    # what it changes
    fault_speed_valid: FaultTable = derived()
    fault_speed_held: FaultTable = derived()
    fault_speed_factor: FaultTable = derived()
    fault_speed_offset: FaultTable = derived()  # m/s
    fault_speed_jump: FaultTable = derived()  # m/s
    fault_drop_out: FaultTable = derived()
    fault_lost_teeth: FaultTable = derived()
    fault_fill_at_least: FaultTable = derived()
    fault_fill_at_most: FaultTable = derived()
    fault_vent_at_least: FaultTable = derived()
    fault_vent_at_most: FaultTable = derived()
    fault_travel_per_step: FaultTable = derived()  # largest change of an opening in a step
    fault_tank_leak: FaultTable = derived()  # m3/(s Pa)
    fault_line_leak: FaultTable = derived()  # m3/(s Pa)
    fault_pressure_held: FaultTable = derived()
    fault_pressure_factor: FaultTable = derived()
    fault_pressure_offset: FaultTable = derived()  # Pa
    fault_silent: FaultTable = derived()
    fault_dynamic_failed: FaultTable = derived()  # 0 or 1
    fault_track_failed: FaultTable = derived()  # 0 or 1
    fault_sander_blocked: FaultTable = derived()  # 0 or 1
    fault_train_speed_valid: FaultTable = derived()
    fault_train_speed_held: FaultTable = derived()
    fault_train_speed_factor: FaultTable = derived()
    fault_train_speed_offset: FaultTable = derived()  # m/s
    fault_release_cycles: FaultTable = derived()  # controller cycles of silence after which the valves fill


SanderTable = Annotated[MutableSequence[float], 4]
"""A number for the sander of each wheelset; zero where there is none."""
SandTable = Annotated[MutableSequence[float], MOST_SAND_POINTS]


class SandTables(Record):
    """Fields of the parameter record that :mod:`uictest.rig.model.sand` reads; all zero without sanders."""

    has_sanders: float = derived()  # 0 or 1; in a train 1 in every car if one has a sander
    sander_rates: SanderTable = derived()  # largest, kg/s
    sander_densities: SanderTable = derived()  # largest, kg/m; infinite: the rate alone counts
    sander_distances: SanderTable = derived()  # of the nozzle ahead of the wheelset, m
    sander_delays: SanderTable = derived()  # controller cycles from the demand to sand on the rail
    sander_off_speeds: SanderTable = derived()  # train speed below which none is demanded, m/s
    # what demands sand: 0 or 1
    sanders_always: SanderTable = derived()
    sanders_on_slide: SanderTable = derived()
    sanders_on_request: SanderTable = derived()
    sander_slide_cycles: SanderTable = derived()  # of a WSP that acts, after which wheels slide
    sander_run_on_cycles: SanderTable = derived()  # of a WSP that rests, after which they do no more
    # on the rail
    sand_points_per_metre: float = derived()  # grid, 1/m
    sand_kept: float = derived()  # share that a wheelset leaves
    sand_friction: float = derived()  # initial friction coefficient with enough sand
    sand_points: int = derived()  # of the table
    sand_densities: SandTable = derived()  # kg/m
    sand_shares: SandTable = derived()  # of the way to the friction with enough sand


class TrackBrakeNumbers(Record):
    """What a case fixes of the track brake: :mod:`uictest.core.physics.brakes`."""

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


class TrainSensor(Record):
    """What a case fixes of them: :mod:`uictest.rig.model.cycle`."""

    has_train_speed: float = derived()  # 0 or 1; where 0, the next four are zero
    train_speed_period: int = derived()  # controller cycles
    train_speed_delay: int = derived()  # controller cycles
    train_speed_noise: float = derived()  # m/s
    train_speed_gain_error: float = derived()
    has_accelerometer: float = derived()  # 0 or 1; where 0, the next two are zero
    accelerometer_noise: float = derived()  # m/s2
    accelerometer_offset: float = derived()  # m/s2


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
    steps_per_cycle: int = derived()
    cycles: int = derived()  # longest stop, in controller cycles
    # keys of the noise
    seed: int = from_scenario("seed")
    noise_key: int = derived()  # rig.train_stop
    # command and topology
    initial_speed: float = from_scenario("initial_speed")  # m/s
    calipers: int = derived()  # modules with a real caliper: 1 or 4
    uses_cylinder_dynamics: float = derived()  # 0 or 1, in modules without a caliper
    uses_module_air: float = derived()  # 0 or 1, in modules without a caliper
    uses_hysteresis: float = derived()  # 0 or 1, in modules without a caliper
    wsp_active: int = derived()  # 0: the valves always fill
    demand_per_pressure: float = derived()  # share of full service per demanded pressure, 1/Pa
    controller: int = derived()  # number of rig.model.controller.CHOICES
    controller_contract: int = derived()  # version that it keeps; from outside: said where it is opened
    # a controller from outside: addresses, set where it is opened
    controller_step: int = derived()
    controller_handle: int = derived()
    controller_exchange: int = derived()
    # dynamic brake: physics.brakes; all zero without one
    has_dynamic_brake: float = derived()  # 0 or 1
    motor_forces: MotorTable = derived()  # of each wheelset, N
    motor_powers: MotorTable = derived()  # W
    motor_response: float = derived()  # share of the missing effort that a motor gains in a controller cycle
    fade_end: float = derived()  # m/s
    fade_rate: float = derived()  # s/m
    zero_force_pressure: float = derived()  # gauge, Pa
    force_per_pressure: float = derived()  # of the car at the rims above that, N/Pa
    coulomb_width: float = derived()  # of the loop of the caliper without load, Pa
    load_width: float = derived()  # what it gains per pressure above zero_force_pressure
    # brake operating unit, reservoir, compressor, brake line
    commanded_pressure: float = derived()  # demanded once the brake is fully applied, gauge, Pa
    dead_time: float = derived()  # from the command to the first demand, s
    filling_rate: float = derived()  # share of the commanded pressure per second
    relay_conductance: float = from_scenario("brake.system.relay_valve.conductance")  # m3/(s Pa)
    relay_gain: float = from_scenario(
        "brake.system.relay_valve.proportional_band", inverse
    )  # opening per missing Pa
    line_volume: float = from_scenario("brake.system.brake_line.volume")  # m3
    line_exchange: float = derived()  # heat conductance to its wall times the step, J/K
    reservoir_volume: float = from_scenario("brake.system.reservoir.volume")  # m3
    reservoir_stiffness: float = derived()  # pressure per mass of air, Pa/kg
    reservoir_pressure: float = derived()  # at the start, Pa
    compressor_cut_in: float = derived()  # Pa
    compressor_cut_out: float = derived()  # Pa
    compressor_delivery: float = from_scenario("brake.system.compressor.delivery")  # kg/s
    # air and orifices
    atmospheric_pressure: float = from_scenario("brake.system.air.atmospheric_pressure")  # Pa
    gas_constant: float = from_scenario("brake.system.air.gas_constant")  # J/(kg K)
    air_temperature: float = from_scenario("brake.system.air.temperature")  # K
    heat_capacity_ratio: float = from_scenario("brake.system.air.heat_capacity_ratio")
    heat_capacity_pressure: float = derived()  # at constant pressure, J/(kg K)
    heat_capacity_volume: float = derived()  # at constant volume, J/(kg K)
    air_coldness: float = derived()  # physics.coldness of the surroundings
    critical_ratio: float = derived()  # this and the next two: physics.orifice_law
    subsonic_scale: float = derived()
    laminar_slope: float = derived()
    # tanks
    tank_volume: float = from_scenario("brake.system.tank.volume")  # module without a caliper, m3
    tank_exchange: float = derived()  # heat conductance to its wall times the step, J/K
    caliper_tank_volume: float = derived()  # module with a caliper, piston at rest, m3
    caliper_tank_exchange: float = derived()  # heat conductance to its wall and balls times the step, J/K
    # caliper
    piston_area: float = from_scenario("rig.caliper.piston_area")  # m2
    preload: float = from_scenario("rig.caliper.preload")  # N
    clearance: float = from_scenario("rig.caliper.clearance")  # m
    piston_damping: float = derived()  # this and the next two: physics.caliper.stiffnesses
    contact_damping: float = derived()
    free_compliance: float = derived()
    contact_stiffness: float = from_scenario("rig.caliper.contact_stiffness")  # N/m
    lever_ratio: float = from_scenario("rig.caliper.lever_ratio")
    # compensation: coefficients of the cylinder's transfer function at this step
    b0: float = derived()
    b1: float = derived()
    b2: float = derived()
    b3: float = derived()
    a1: float = derived()
    a2: float = derived()
    a3: float = derived()
    # compensation: modelled air of the caliper's module, physics.air
    modelled_tank_exchange: float = derived()  # Pa
    modelled_exchange: float = derived()  # Pa
    modelled_fill_conductance: float = derived()  # air in a step over the reduced flow
    modelled_vent_conductance: float = derived()
    modelled_swept_share: float = derived()  # of a tank's volume
    modelled_closing_pressure: float = derived()  # Pa
    modelled_opening_pressure: float = derived()  # Pa
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
    phase_change_per_step: float = derived()  # share of the way between the two pairs of lines
    wsp_acting_cycles: int = derived()  # cycles of filling after which the WSP no longer counts as acting
    # compensation: how far the rig is from the one it was identified for, over the tolerance; NaN: not known
    compensation_misfit: float = derived()
    # disc brake
    calipers_per_wheelset: float = from_scenario("brake.system.disc.calipers_per_wheelset")
    pads_per_caliper: float = from_scenario("brake.system.disc.pads_per_caliper")
    disc_radius: float = from_scenario("brake.system.disc.mean_radius")  # m
    # factors of the pad friction over m/s, N and K: tables, and physics.quotient_factor
    varies_pad_friction: float = derived()  # 0 or 1
    pad_speeds: PadTable = derived()
    pad_speed_factors: PadTable = derived()
    pad_speed_points: int = derived()
    pad_speed_numerator: float = derived()
    pad_speed_denominator: float = derived()
    pad_speed_scale: float = derived()
    pad_forces: PadTable = derived()
    pad_force_factors: PadTable = derived()
    pad_force_points: int = derived()
    pad_force_numerator: float = derived()
    pad_force_denominator: float = derived()
    pad_force_scale: float = derived()
    pad_temperatures: PadTable = derived()
    pad_temperature_factors: PadTable = derived()
    pad_temperature_points: int = derived()
    # temperature of the discs of a wheelset in a controller cycle: physics.brakes
    models_disc_temperature: float = derived()  # 0 or 1; where 0, all of the following but one are zero
    initial_disc_temperature: float = derived()  # K
    disc_heat_capacity: float = derived()  # J/K
    disc_warming: float = derived()  # of the bulk, K/J
    disc_relaxation: float = derived()  # of the bulk to the air's temperature, share
    disc_held_rise: float = derived()  # of the modes that are not followed, K/J
    disc_rise_1: float = derived()  # of the modes of the temperature profile, K/J
    disc_rise_2: float = derived()
    disc_rise_3: float = derived()
    disc_rise_4: float = derived()
    disc_rise_5: float = derived()
    disc_rise_6: float = derived()
    disc_relaxation_1: float = derived()  # of these modes, share
    disc_relaxation_2: float = derived()
    disc_relaxation_3: float = derived()
    disc_relaxation_4: float = derived()
    disc_relaxation_5: float = derived()
    disc_relaxation_6: float = derived()
    # car body and bogies
    body_mass: float = derived()  # with its load, kg
    body_inertia: float = derived()  # kg m2
    body_mass_rate: float = derived()  # mass over step, kg/s
    body_mass_response: float = derived()  # step over mass, s/kg
    body_pitch_response: float = derived()  # step over inertia, s/(kg m2)
    body_height: float = from_scenario("vehicle.body.height")  # m
    bogie_mass: float = from_scenario("vehicle.bogie.mass")  # kg
    bogie_inertia: float = from_scenario("vehicle.bogie.pitch_inertia")  # kg m2
    bogie_mass_response: float = derived()  # s/kg
    bogie_pitch_response: float = derived()  # s/(kg m2)
    bogie_height: float = from_scenario("vehicle.bogie.height")  # m
    half_wheelbase: float = from_scenario("vehicle.bogie.half_wheelbase")  # m
    half_pivot_distance: float = from_scenario("vehicle.half_pivot_distance")  # m
    # wheelset
    wheelset_mass: float = from_scenario("vehicle.wheelset.mass")  # kg
    mass_response: float = derived()  # step over wheelset mass, s/kg
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
    gravity: float = derived()  # m/s2
    total_mass: float = derived()  # of the car, kg
    static_wheel_load: float = derived()  # of one wheel, N
    # wheel and rail
    gradient: float = from_scenario("rail.gradient")  # positive uphill
    friction_ratio: float = from_scenario("rail.condition.friction_ratio")
    friction_decay: float = from_scenario("rail.condition.friction_decay")  # s/m
    reduction_adhesion: float = from_scenario("rail.condition.reduction_adhesion")
    reduction_slip: float = from_scenario("rail.condition.reduction_slip")
    creep_stiffness: float = derived()  # (1/4) G pi a b c11 at the reference load, N
    reference_load: float = from_scenario("rail.condition.contact.reference_wheel_load")  # N
    load_scale: float = from_scenario("rail.condition.contact.reference_wheel_load", inverse)  # 1/N
    # largest creep force: physics.rail
    highest_creep_scale: float = derived()  # s/m
    highest_creep_0: float = derived()
    highest_creep_1: float = derived()
    highest_creep_2: float = derived()
    highest_creep_3: float = derived()
    highest_creep_4: float = derived()
    highest_creep_5: float = derived()
    highest_creep_6: float = derived()
    highest_creep_7: float = derived()
    friction_points: int = derived()  # points of the friction along the track
    friction_times: int = derived()  # points of its factor over time
    # friction that varies at random along the track: rig.model.rail
    varies_friction: float = derived()  # 0 or 1; where 0, all of the following are zero
    variation_points_per_metre: float = derived()
    variation_persistence: float = derived()  # correlation of two neighbouring points
    variation_renewal: float = derived()  # share of a point that its neighbour does not decide
    variation_log_spread: float = derived()
    # rail cleaned by sliding: physics.rail
    cleans_rail: float = derived()  # 0 or 1
    rail_law: int = derived()  # number of core.rail_laws.LAWS
    law_numbers: LawNumbers = derived()  # its own
    cleaning_response: float = derived()  # cleaned share per energy per metre of track, m/J
    cleaning_decay: float = derived()  # 1/m
    recovered_friction: float = derived()
    clean_friction_ratio: float = derived()  # this and the next three: of a clean rail
    clean_friction_decay: float = derived()  # s/m
    clean_reduction_adhesion: float = derived()
    clean_reduction_slip: float = derived()
    spent_share: float = derived()  # that earlier stops have cleaned
    clean_highest_creep_scale: float = derived()  # as highest_creep_*, of a clean rail
    clean_highest_creep_0: float = derived()
    clean_highest_creep_1: float = derived()
    clean_highest_creep_2: float = derived()
    clean_highest_creep_3: float = derived()
    clean_highest_creep_4: float = derived()
    clean_highest_creep_5: float = derived()
    clean_highest_creep_6: float = derived()
    clean_highest_creep_7: float = derived()
    carry_over: float = derived()
    rail_points_per_metre: float = derived()  # grid of rig.model.rail, 1/m
    uses_pole_wheels: float = derived()  # 0 or 1: a wheelset has a sensor that counts teeth
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
    inertia_response: float = derived()  # step over that, s/(kg m2)
    inertia_stiffness: float = derived()  # its inverse
    slip_response: float = derived()  # change of slip speed in a step per creep force, m/(s N)
    slip_stiffness: float = derived()  # its inverse
    # disc brake
    brake_force: float = from_scenario("brake_force")  # share of the regular torque
    reference_pad_friction: float = from_scenario("pad_friction")  # where the factors of the pads are 1
    # caliper
    coulomb_friction: float = from_scenario("caliper.coulomb_friction")  # N
    squeezing_stiffness: float = derived()  # this and the next three: physics.caliper.stiffnesses
    releasing_stiffness: float = derived()
    squeezing_compliance: float = derived()
    releasing_compliance: float = derived()
    # WSP valve
    fill_conductance: float = from_scenario("wsp_valve.fill_conductance")  # m3/(s Pa)
    vent_conductance: float = from_scenario("wsp_valve.vent_conductance")  # m3/(s Pa)
    valve_travel_per_step: float = derived()  # share of full opening
    valve_delay_cycles: int = derived()  # whole controller cycles of the switching delay
    valve_delay_steps: float = derived()  # and the steps that remain of it
    # sensors
    tooth_pitch: float = derived()  # at the tread of a wheel of the configured radius, m
    timer_resolution: float = from_scenario("sensors.speed.timer_resolution")  # s
    slowest_measured_speed: float = from_scenario("sensors.speed.minimum_speed")  # m/s
    speed_noise: float = from_scenario("sensors.speed.noise")  # share of the reading
    speed_gain_error: float = from_scenario("sensors.speed.gain_error")
    counts_teeth: float = derived()  # 0 or 1: the speed is that of the last whole teeth
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
