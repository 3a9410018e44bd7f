"""Layout of the numbers that the rig steps: parameters, car, bogie and wheelset.

SI units; pressures are absolute unless named gauge.

Fields are attributes in plain Python and in compiled code alike. The order of fields carries no meaning.
"""

import numpy as np

from uictest.controllers import CAR_MEMORY, WHEELSET_MEMORY
from uictest.measures import DEFINITION

_PARAMETERS = [
    # time
    ("step", "f8"),  # base step, s
    ("cycle_time", "f8"),  # controller cycle, s
    ("steps_per_cycle", "i8"),
    ("cycles", "i8"),  # longest stop, in controller cycles
    # keys of the noise
    ("seed", "i8"),
    ("case_key", "i8"),
    # command and topology
    ("initial_speed", "f8"),
    ("calipers", "i8"),  # modules with a real caliper: 1 or 4
    ("uses_cylinder_dynamics", "f8"),  # 0 or 1, in modules without a caliper
    ("uses_hysteresis", "f8"),  # 0 or 1, in modules without a caliper
    ("wsp_active", "i8"),  # 0: the valves always fill
    ("algorithm", "i8"),  # place in controllers.ALGORITHMS
    # brake operating unit, reservoir, compressor, brake line
    ("demanded_pressure", "f8"),  # of the command, gauge, Pa
    ("dead_time", "f8"),
    ("filling_rate", "f8"),  # share of the demanded pressure per second
    ("relay_conductance", "f8"),  # m3/(s Pa)
    ("relay_gain", "f8"),  # opening per missing pressure, 1/Pa
    ("line_volume", "f8"),
    ("line_stiffness", "f8"),  # polytropic exponent over its volume, 1/m3
    ("reservoir_volume", "f8"),
    ("reservoir_stiffness", "f8"),  # pressure per mass of air, Pa/kg
    ("reservoir_pressure", "f8"),  # at the start
    ("compressor_cut_in", "f8"),
    ("compressor_cut_out", "f8"),
    ("compressor_delivery", "f8"),  # kg/s
    # air and orifices
    ("atmospheric_pressure", "f8"),
    ("gas_constant", "f8"),
    ("air_temperature", "f8"),
    ("air", "f8"),  # gas constant times temperature, J/kg
    ("polytropic_exponent", "f8"),
    ("flow_density", "f8"),  # this and the next three: physics.flow.orifice_law
    ("critical_ratio", "f8"),
    ("subsonic_scale", "f8"),
    ("laminar_slope", "f8"),
    # WSP valve and tanks
    ("fill_conductance", "f8"),
    ("vent_conductance", "f8"),
    ("valve_travel_per_step", "f8"),
    ("valve_delay_cycles", "i8"),  # whole controller cycles of the switching delay
    ("valve_delay_steps", "f8"),  # and the steps that remain of it
    ("tank_volume", "f8"),  # module without a caliper
    ("caliper_tank_volume", "f8"),  # module with a caliper, piston at rest
    # caliper
    ("piston_area", "f8"),
    ("preload", "f8"),
    ("coulomb_friction", "f8"),
    ("clearance", "f8"),
    ("piston_damping", "f8"),  # this and the next five: physics.caliper.stiffnesses
    ("squeezing_stiffness", "f8"),
    ("releasing_stiffness", "f8"),
    ("free_compliance", "f8"),
    ("squeezing_compliance", "f8"),
    ("releasing_compliance", "f8"),
    ("contact_stiffness", "f8"),
    ("lever_ratio", "f8"),
    # compensation
    ("b0", "f8"),
    ("b1", "f8"),
    ("b2", "f8"),
    ("b3", "f8"),
    ("a1", "f8"),
    ("a2", "f8"),
    ("a3", "f8"),
    ("linear_slope", "f8"),  # N/Pa
    ("linear_intercept", "f8"),  # N
    ("bc_squeezing_slope", "f8"),
    ("bc_squeezing_intercept", "f8"),
    ("bc_releasing_slope", "f8"),
    ("bc_releasing_intercept", "f8"),
    ("wsp_squeezing_slope", "f8"),
    ("wsp_squeezing_intercept", "f8"),
    ("wsp_releasing_slope", "f8"),
    ("wsp_releasing_intercept", "f8"),
    ("phase_change_per_step", "f8"),
    ("wsp_acting_cycles", "i8"),  # cycles of filling after which the WSP no longer counts as acting
    # disc brake
    ("calipers_per_wheelset", "f8"),
    ("pads_per_caliper", "f8"),
    ("pad_friction", "f8"),
    ("disc_radius", "f8"),
    # vehicle
    ("body_mass", "f8"),
    ("body_inertia", "f8"),
    ("body_mass_response", "f8"),  # step over mass, s/kg
    ("body_pitch_response", "f8"),  # step over inertia, s/(kg m2)
    ("body_height", "f8"),
    ("bogie_mass", "f8"),
    ("bogie_inertia", "f8"),
    ("bogie_mass_response", "f8"),
    ("bogie_pitch_response", "f8"),
    ("bogie_height", "f8"),
    ("half_wheelbase", "f8"),
    ("half_pivot_distance", "f8"),
    ("wheelset_mass", "f8"),
    ("wheelset_inertia", "f8"),
    ("wheel_radius", "f8"),
    ("mass_response", "f8"),  # step over wheelset mass, s/kg
    ("inertia_response", "f8"),  # step over wheelset inertia, s/(kg m2)
    ("inertia_stiffness", "f8"),  # its inverse
    ("slip_response", "f8"),  # change of slip speed in a step per creep force, m/(s N)
    ("slip_stiffness", "f8"),  # its inverse
    ("primary_longitudinal_stiffness", "f8"),  # per wheelset
    ("primary_longitudinal_damping", "f8"),
    ("primary_vertical_stiffness", "f8"),
    ("primary_vertical_damping", "f8"),
    ("secondary_longitudinal_stiffness", "f8"),  # per bogie
    ("secondary_longitudinal_damping", "f8"),
    ("secondary_vertical_stiffness", "f8"),
    ("secondary_vertical_damping", "f8"),
    ("secondary_height", "f8"),
    ("link_stiffness", "f8"),  # per bogie
    ("link_damping", "f8"),
    ("link_height", "f8"),
    ("resistance_constant", "f8"),
    ("resistance_linear", "f8"),
    ("resistance_quadratic", "f8"),
    ("gravity", "f8"),
    ("static_wheel_load", "f8"),  # of one wheel, N
    # wheel and rail
    ("gradient", "f8"),  # positive uphill
    ("friction_ratio", "f8"),
    ("friction_decay", "f8"),
    ("reduction_adhesion", "f8"),
    ("reduction_slip", "f8"),
    ("creep_stiffness", "f8"),  # (1/4) G pi a b c11 at the reference load, N
    ("reference_load", "f8"),
    ("load_scale", "f8"),  # its inverse
    ("friction_points", "i8"),
    ("friction_times", "i8"),
    # sensors
    ("tooth_pitch", "f8"),  # at the tread, m
    ("timer_resolution", "f8"),
    ("slowest_measured_speed", "f8"),
    ("speed_noise", "f8"),
    ("pressure_range", "f8"),
    ("pressure_gain_error", "f8"),
    ("pressure_offset", "f8"),
    ("pressure_noise", "f8"),
    ("pressure_resolution", "f8"),
    ("pressure_steps", "f8"),  # per Pa
    ("loadcell_range", "f8"),
    ("loadcell_gain_error", "f8"),
    ("loadcell_offset", "f8"),
    ("loadcell_noise", "f8"),
    ("loadcell_resolution", "f8"),
    ("loadcell_steps", "f8"),  # per N
    # threshold controller
    ("slip_threshold", "f8"),
    ("slide_threshold", "f8"),
    ("deep_slide", "f8"),
    ("vent_deceleration", "f8"),
    ("hold_deceleration", "f8"),
    ("reacceleration_threshold", "f8"),
    ("acceleration_filter_time", "f8"),
    ("reference_deceleration", "f8"),
    ("holding_deceleration", "f8"),
    ("rolling_time", "f8"),
    ("sounding_interval", "f8"),
    ("sounding_time", "f8"),
    ("minimum_speed", "f8"),
    ("vent_watchdog", "f8"),
    ("hold_limit", "f8"),
    ("recovery_share", "f8"),
    ("fill_pulse_on", "f8"),
    ("fill_pulse_off", "f8"),
    ("refill_time", "f8"),
    # slip-band controller
    ("lower_slide", "f8"),
    ("upper_slide", "f8"),
    ("band_reference_deceleration", "f8"),
    ("band_minimum_speed", "f8"),
]
PARAMETERS = np.dtype((np.record, [*_PARAMETERS, *DEFINITION]))
"""Everything that a case fixes."""

CAR = np.dtype(
    (
        np.record,
        [
            ("steps", "f8"),  # done so far
            ("substep", "f8"),  # within the controller cycle
            ("cycle", "i8"),  # of the controller, begun so far
            ("time", "f8"),  # steps x step, never accumulated
            # motion of the car body
            ("position", "f8"),
            ("speed", "f8"),
            ("height", "f8"),
            ("vertical_speed", "f8"),
            ("pitch", "f8"),
            ("pitch_rate", "f8"),
            ("longitudinal_force", "f8"),
            ("vertical_force", "f8"),
            ("moment", "f8"),
            # air
            ("reservoir_mass", "f8"),
            ("reservoir_pressure", "f8"),
            ("compressor_running", "f8"),
            ("line_pressure", "f8"),
            ("line_mass", "f8"),
            ("demand", "f8"),  # gauge, Pa
            # ledgers
            ("compressor_air", "f8"),  # delivered, kg
            ("consumed_air", "f8"),  # taken from the reservoir, kg
            ("exhausted_air", "f8"),  # let out by the relay valve, kg
            ("damper_loss", "f8"),  # J
            ("resistance_loss", "f8"),  # J
            ("initial_energy", "f8"),  # J
            ("initial_air", "f8"),  # kg
            # standstill, interpolated within the step
            ("stopped", "f8"),
            ("stop_time", "f8"),
            ("stop_position", "f8"),
            *CAR_MEMORY,
        ],
    )
)
"""State of the car body, the air supply and the ledgers."""

BOGIE = np.dtype(
    (
        np.record,
        [
            ("ahead", "f8"),  # of the car body's centre, m
            ("position", "f8"),
            ("speed", "f8"),
            ("height", "f8"),
            ("vertical_speed", "f8"),
            ("pitch", "f8"),
            ("pitch_rate", "f8"),
            ("longitudinal_force", "f8"),
            ("vertical_force", "f8"),
            ("moment", "f8"),
        ],
    )
)
"""State of one bogie frame; two of them."""

WHEELSET = np.dtype(
    (
        np.record,
        [
            ("has_caliper", "f8"),  # 1 when its module has a real caliper, 0 when it is a tank
            ("ahead", "f8"),  # of its bogie's centre, m
            ("behind", "f8"),  # the leading wheelset, m
            # valve
            ("command", "i8"),  # newest command of the controller
            ("command_register", "i8"),  # the commands before it
            ("filling_cycles", "i8"),  # since the last command other than fill
            ("fill_before", "f8"),  # target openings before and after the switching instant of this cycle
            ("fill_after", "f8"),
            ("vent_before", "f8"),
            ("vent_after", "f8"),
            ("fill_opening", "f8"),
            ("vent_opening", "f8"),
            ("venting", "f8"),  # 1 while the newest command is to vent
            ("wsp_acting", "f8"),
            # air
            ("pressure", "f8"),
            ("air_mass", "f8"),
            ("vented_air", "f8"),
            # caliper
            ("stroke", "f8"),
            ("stroke_change", "f8"),
            ("caliper_force", "f8"),
            # compensation
            ("memory_1", "f8"),
            ("memory_2", "f8"),
            ("memory_3", "f8"),
            ("wsp_share", "f8"),
            ("compensated_pressure", "f8"),  # gauge, after the cylinder dynamics
            ("computed_force", "f8"),
            # sensors, held for a controller cycle
            ("pressure_error", "f8"),  # momentary noise, Pa
            ("loadcell_error", "f8"),  # N
            ("measured_speed", "f8"),
            # brake and rail
            ("clamping_force", "f8"),  # as the vehicle simulation receives it
            ("torque", "f8"),
            ("friction", "f8"),
            ("wheel_load", "f8"),
            ("thrust", "f8"),  # of suspension and gradient on the wheelset
            ("contact_stiffness", "f8"),
            ("creep_force", "f8"),  # of both wheels, against the motion
            # search for the slip speed within a step: sizes, m/s
            ("slip_direction", "f8"),
            ("free_slip", "f8"),
            ("lowest_slip", "f8"),
            ("highest_slip", "f8"),
            ("slip_estimate", "f8"),
            ("sliding_force", "f8"),  # creep force at the last slip speed, N
            # creep at the estimated slip speed: physics.polach.stress_gradient
            ("friction_limit", "f8"),  # of one wheel, N
            ("limit_slope", "f8"),  # N s/m
            ("stress_pull", "f8"),
            ("stress_hold", "f8"),
            ("inverse_adhesion", "f8"),
            ("inverse_slip", "f8"),
            ("stress_angle", "f8"),
            ("stress_tangent", "f8"),
            # motion
            ("position", "f8"),
            ("speed", "f8"),
            ("rotation", "f8"),
            ("slip_speed", "f8"),
            # ledgers
            ("brake_heat", "f8"),  # J
            ("contact_loss", "f8"),  # J
            *WHEELSET_MEMORY,
        ],
    )
)
"""State of one wheelset and its module; four of them, numbered from the leading end."""
