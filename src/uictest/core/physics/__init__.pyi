from .arithmetic import (
    clamp as clamp,
    floor as floor,
    fma as fma,
    maximum as maximum,
    minimum as minimum,
    select as select,
    sqrt as sqrt,
)
from .brake_operating_unit import demanded_pressure as demanded_pressure, relay_opening as relay_opening
from .caliper import (
    clamping_force as clamping_force,
    stiffnesses as stiffnesses,
    stroke_after as stroke_after,
)
from .cylinder import memory as memory, output as output
from .disc_brake import torque as torque
from .disc_temperature import (
    MODES as MODES,
    bulk_change as bulk_change,
    cooled_heat as cooled_heat,
    held_mode as held_mode,
    held_rest as held_rest,
    mode_after as mode_after,
    mode_relaxation as mode_relaxation,
    relaxed_share as relaxed_share,
)
from .flow import (
    REFERENCE_DENSITY as REFERENCE_DENSITY,
    REFERENCE_TEMPERATURE as REFERENCE_TEMPERATURE,
    coldness as coldness,
    mass_flow as mass_flow,
    orifice_law as orifice_law,
    reduced_flow as reduced_flow,
)
from .friction_maximum import (
    FITTED_TERMS as FITTED_TERMS,
    highest_creep_force as highest_creep_force,
)
from .hysteresis import force_after as force_after, line as line, phase_share as phase_share
from .module_air import (
    amount_gained as amount_gained,
    pressure_volume_after as pressure_volume_after,
    travel_after as travel_after,
)
from .noise import bell as bell, threefry as threefry, uniform as uniform
from .pad_friction import (
    MOST_PAD_POINTS as MOST_PAD_POINTS,
    quotient_factor as quotient_factor,
    quotient_scale as quotient_scale,
)
from .polach import (
    contact_stiffness as contact_stiffness,
    creep_force as creep_force,
    force_and_slope as force_and_slope,
    friction_limit as friction_limit,
    stress_gradient as stress_gradient,
)
from .pole_wheel import (
    last_tooth as last_tooth,
    passed_turns as passed_turns,
    passing_rate as passing_rate,
    speed_of_teeth as speed_of_teeth,
    time_since as time_since,
)
from .rail import interpolated as interpolated
from .rail_cleaning import (
    cleaned_friction as cleaned_friction,
    cleaned_share as cleaned_share,
    share_left_behind as share_left_behind,
)
from .reservoir import compressor_running as compressor_running, isothermal_pressure as isothermal_pressure
from .resistance import gradient_force as gradient_force, running_resistance as running_resistance
from .sensors import (
    analogue_reading as analogue_reading,
    beyond_range as beyond_range,
    speed_reading as speed_reading,
)
from .tank import air_changes as air_changes, enthalpy as enthalpy
from .vehicle import (
    kinetic_energy as kinetic_energy,
    longitudinal as longitudinal,
    spring_energy as spring_energy,
    suspension_force as suspension_force,
    vertical as vertical,
)
from .wheelset import (
    SLOWEST_CREEP as SLOWEST_CREEP,
    locked_force as locked_force,
    lowest_slip as lowest_slip,
    refined_slip as refined_slip,
    turning_direction as turning_direction,
)
from .wsp_valve import (
    FILL as FILL,
    HOLD as HOLD,
    LONGEST_DELAY_CYCLES as LONGEST_DELAY_CYCLES,
    VENT as VENT,
    command_before as command_before,
    remember as remember,
    travel as travel,
)
