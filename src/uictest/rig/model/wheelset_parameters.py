"""Parameters that may differ from wheelset to wheelset, each declared once.

:func:`~uictest.core.record.from_scenario` names a value as :func:`uictest.plans.scenario.wheelset_value`
does; what is :func:`~uictest.core.record.derived` is computed in
:mod:`uictest.rig.derived_wheelset_parameters`. SI units. The state of a wheelset has these fields as well:
the step reads them there.
"""

from uictest.core.record import FieldCopier, Record, derived, from_scenario, layout_of


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
