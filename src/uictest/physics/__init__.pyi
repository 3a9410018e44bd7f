from .arithmetic import (
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
from .flow import (
    REFERENCE_DENSITY as REFERENCE_DENSITY,
    coldness as coldness,
    mass_flow as mass_flow,
    orifice_law as orifice_law,
    reduced_flow as reduced_flow,
)
from .hysteresis import force_after as force_after, line as line, phase_share as phase_share
from .module_air import (
    amount_gained as amount_gained,
    pressure_volume_after as pressure_volume_after,
    travel_after as travel_after,
)
from .noise import bell as bell, threefry as threefry
from .polach import (
    contact_stiffness as contact_stiffness,
    creep_force as creep_force,
    force_and_slope as force_and_slope,
    friction_limit as friction_limit,
    stress_gradient as stress_gradient,
)
from .rail import interpolated as interpolated
from .reservoir import compressor_running as compressor_running, isothermal_pressure as isothermal_pressure
from .resistance import gradient_force as gradient_force, running_resistance as running_resistance
from .sensors import analogue_reading as analogue_reading, speed_reading as speed_reading
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
