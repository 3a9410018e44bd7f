/* Orifice, tank, reservoir, compressor, relay valve and WSP valve. */
#ifndef AIR_H
#define AIR_H

#include "arithmetic.h"

OURS real mass_flow(real pressure_1, real pressure_2, real conductance, real density, real critical_ratio,
                    real subsonic_scale, real laminar_slope)
{
    real upstream = maximum(pressure_1, pressure_2);
    real downstream = minimum(pressure_1, pressure_2);
    real direction = choose(pressure_2 > pressure_1, number(-1.0), number(1.0));
    real subsonic = maximum(fma(-critical_ratio, upstream, downstream), number(0.0)) * subsonic_scale;
    real curve = sqrt_of(maximum(fma(-subsonic, subsonic, upstream * upstream), number(0.0)));
    real chord = (upstream - downstream) * laminar_slope;
    return direction * (conductance * density) * minimum(curve, chord);
}

OURS real pressure_change(real pressure, real stiffness, real mass_change, real volume_change, real air)
{
    return stiffness * fma(air, mass_change, -pressure * volume_change);
}

OURS real demanded_pressure(real time, real commanded_pressure, real dead_time, real filling_rate)
{
    return commanded_pressure * clamp((time - dead_time) * filling_rate, number(0.0), number(1.0));
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
