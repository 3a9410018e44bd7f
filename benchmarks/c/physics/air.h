/* Orifice, tank, reservoir, compressor, relay valve and WSP valve. */
#ifndef AIR_H
#define AIR_H

#include "arithmetic.h"

OURS real mass_flow(real pressure_1, real pressure_2, real inverse_upstream, real conductance, real density,
                    real critical_ratio, real subsonic_scale, real laminar_ratio, real laminar_scale)
{
    real upstream = maximum(pressure_1, pressure_2);
    real downstream = minimum(pressure_1, pressure_2);
    real ratio = downstream * inverse_upstream;
    real direction = choose(pressure_2 > pressure_1, number(-1.0), number(1.0));
    real subsonic = maximum((minimum(ratio, laminar_ratio) - critical_ratio) * subsonic_scale, number(0.0));
    real laminar = minimum((upstream - downstream) * inverse_upstream * laminar_scale, number(1.0));
    return direction * upstream * conductance * density * sqrt_of(1.0 - subsonic * subsonic) * laminar;
}

OURS real pressure_change(real pressure, real stiffness, real mass_change, real volume_change, real air)
{
    return stiffness * (air * mass_change - pressure * volume_change);
}

OURS real demand(real time, real full_demand, real dead_time, real fill_time)
{
    return full_demand * clamp((time - dead_time) / fill_time, number(0.0), number(1.0));
}

OURS real relay_opening(real demanded, real pressure, real proportional_band)
{
    return clamp((demanded - pressure) / proportional_band, number(-1.0), number(1.0));
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
