/* Caliper, cylinder dynamics, hysteresis, analogue sensor, disc brake. */
#ifndef CLAMPING_FORCE_H
#define CLAMPING_FORCE_H

#include "arithmetic.h"

OURS real stroke_after(real stroke, real pressure, real piston_area, real preload, real coulomb_friction,
                       real clearance, real damping, real contact_damping, real squeezing_stiffness,
                       real releasing_stiffness, real free_compliance, real squeezing_compliance,
                       real releasing_compliance)
{
    real compressed = maximum(stroke - clearance, number(0.0));
    real held_back = fma(damping, stroke, fma(contact_damping, compressed, -preload));
    real load = fma(pressure, piston_area, held_back);
    real squeezing_load = load - coulomb_friction;
    real releasing_load = load + coulomb_friction;
    real squeezing = minimum(squeezing_load * free_compliance,
                             fma(squeezing_stiffness, clearance, squeezing_load) * squeezing_compliance);
    real releasing = minimum(releasing_load * free_compliance,
                             fma(releasing_stiffness, clearance, releasing_load) * releasing_compliance);
    return maximum(clamp(stroke, squeezing, releasing), number(0.0));
}

OURS real clamping_force(real stroke, real clearance, real contact_stiffness, real lever_ratio)
{
    return lever_ratio * contact_stiffness * maximum(stroke - clearance, number(0.0));
}

OURS real cylinder_output(real pressure, real memory_1, real b0) { return fma(b0, pressure, memory_1); }

OURS real cylinder_memory(real pressure, real filtered, real b, real a, real following)
{
    return fma(b, pressure, fma(-a, filtered, following));
}

OURS real phase_share(real share, real wsp_acting, real largest_change)
{
    return share + clamp(wsp_acting - share, -largest_change, largest_change);
}

OURS real force_line(real pressure, real slope, real intercept)
{
    return maximum(fma(slope, pressure, intercept), number(0.0));
}

OURS real force_after(real force, real squeezing, real releasing)
{
    return clamp(force, squeezing, maximum(squeezing, releasing));
}

/* Nearest whole number: the sum must not be simplified away, not even by -ffast-math. */
OURS real nearest(real x)
{
    real sum = x + 6755399441055744.0;
    __asm__("" : "+m"(sum));
    return sum - 6755399441055744.0;
}

OURS real analogue_reading(real value, real gain_error, real offset, real noise, real measuring_range,
                           real resolution, real steps_per_unit)
{
    real limited = clamp(fma(value, 1.0 + gain_error, offset + noise), number(0.0), measuring_range);
    return nearest(limited * steps_per_unit) * resolution;
}

OURS real beyond_range(real value, real gain_error, real offset, real noise, real measuring_range)
{
    return choose(fma(value, 1.0 + gain_error, offset + noise) > measuring_range, number(1.0), number(0.0));
}

OURS real brake_torque(real force, real calipers, real pads, real pad_friction, real mean_radius)
{
    return calipers * pads * pad_friction * force * mean_radius;
}

#endif
