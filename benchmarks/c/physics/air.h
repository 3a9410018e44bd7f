/* Orifice, tank, reservoir, compressor, relay valve and WSP valve. */
#ifndef AIR_H
#define AIR_H

#include "arithmetic.h"

#define REFERENCE_DENSITY 1.185
#define REFERENCE_TEMPERATURE 293.15

OURS real coldness(real temperature) { return REFERENCE_TEMPERATURE / temperature; }

OURS real reduced_flow(real pressure_1, real pressure_2, real coldness_1, real coldness_2, real critical_ratio,
                       real subsonic_scale, real laminar_slope)
{
    mask backwards = pressure_2 > pressure_1;
    real upstream = maximum(pressure_1, pressure_2);
    real downstream = minimum(pressure_1, pressure_2);
    real subsonic = maximum(fma(-critical_ratio, upstream, downstream), number(0.0)) * subsonic_scale;
    real curve_squared = maximum(fma(-subsonic, subsonic, upstream * upstream), number(0.0));
    real chord = (upstream - downstream) * laminar_slope;
    real size = sqrt_of(choose(backwards, coldness_2, coldness_1) * minimum(curve_squared, chord * chord));
    return choose(backwards, -size, size);
}

OURS real mass_flow(real pressure_1, real pressure_2, real coldness_1, real coldness_2, real conductance,
                    real critical_ratio, real subsonic_scale, real laminar_slope)
{
    return conductance * REFERENCE_DENSITY *
           reduced_flow(pressure_1, pressure_2, coldness_1, coldness_2, critical_ratio, subsonic_scale, laminar_slope);
}

OURS real enthalpy(real flow, real temperature_1, real temperature_2, real heat_capacity)
{
    return flow * heat_capacity * choose(flow < 0.0, temperature_2, temperature_1);
}

/* Changes of temperature (returned) and of pressure within a step. */
OURS real air_changes(real pressure, real temperature, real mass, real gained, real energy, real volume, real growth,
                  real wall_temperature, real exchange, real gas_constant, real heat_capacity, real *rise)
{
    real work = pressure * growth;
    real carried = temperature * gained;
    real capacity = fma(mass, heat_capacity, exchange);
    real inverse = 1.0 / (capacity * volume);
    real heated = fma(exchange, wall_temperature - temperature, fma(-heat_capacity, carried, energy - work));
    real warming = heated * (volume * inverse);
    *rise = fma(gas_constant, fma(mass, warming, carried), -work) * (capacity * inverse);
    return warming;
}

OURS real demanded_pressure(real time, real commanded_pressure, real dead_time, real filling_rate)
{
    return commanded_pressure * clamp((time - dead_time) * filling_rate, number(0.0), number(1.0));
}

OURS real friction_pressure(real pressure, real share, real zero_force_pressure)
{
    return pressure - share * maximum(pressure - zero_force_pressure, number(0.0));
}

OURS real relay_opening(real demanded_pressure, real pressure, real gain)
{
    return clamp((demanded_pressure - pressure) * gain, number(-1.0), number(1.0));
}

OURS real compressor_running(real pressure, real running, real cut_in, real cut_out)
{
    return choose(pressure < cut_in, number(1.0), choose(pressure > cut_out, number(0.0), running));
}

OURS real isothermal_pressure(real mass, real stiffness) { return mass * stiffness; }

OURS real travel(real opening, real target, real largest_change)
{
    return opening + clamp(target - opening, -largest_change, largest_change);
}

#endif
