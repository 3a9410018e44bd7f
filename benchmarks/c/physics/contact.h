/* Polach's creep force and one wheelset on the rail. */
#ifndef CONTACT_H
#define CONTACT_H

#include "arithmetic.h"

#define SLOWEST_CREEP 0.01
#define TWO_OVER_PI 0.6366197723675814

OURS real contact_stiffness(real reference_stiffness, real load_ratio)
{
    return reference_stiffness * power_two_thirds(load_ratio);
}

OURS real creep_force(real slip_speed, real speed, real wheel_load, real stiffness, real initial_friction, real ratio,
                      real decay, real reduction_adhesion, real reduction_slip, real *slope)
{
    real fading = (1.0 - ratio) * exponential(-decay * slip_speed);
    real limit = wheel_load * initial_friction * (fading + ratio);
    real limit_slope = -decay * wheel_load * initial_friction * fading;
    real inverse = 1.0 / (speed * limit);
    real gradient = stiffness * inverse;
    real eps = gradient * slip_speed;
    real adhering = reduction_adhesion * eps;
    real slipping = reduction_slip * eps;
    real adhesion_part = 1.0 + adhering * adhering;
    real slip_part = 1.0 + slipping * slipping;
    real both = 1.0 / (adhesion_part * slip_part);
    real flatness = slip_part * both;
    real shape = adhering * flatness + arctan(slipping);
    real bend = (2.0 - adhesion_part) * flatness * flatness;
    real shape_slope = reduction_adhesion * bend + reduction_slip * adhesion_part * both;
    real eps_slope = gradient - eps * limit_slope * speed * inverse;
    *slope = TWO_OVER_PI * (limit_slope * shape + limit * shape_slope * eps_slope);
    return TWO_OVER_PI * limit * shape;
}

OURS real lowest_slip(real free_slip, real softness, real wheel_load, real initial_friction)
{
    return maximum(free_slip - softness * 2.0 * wheel_load * initial_friction, number(0.0));
}

/* One Newton step; narrows the bracket in place. */
OURS real refined_slip(real slip, real *low, real *high, real free_slip, real softness, real force, real slope)
{
    real residual = slip + softness * 2.0 * force - free_slip;
    real rise = 1.0 + softness * 2.0 * slope;
    *high = choose(residual > 0.0, minimum(slip, *high), *high);
    *low = choose(residual > 0.0, *low, maximum(slip, *low));
    real newton = slip - residual / choose(rise > 0.0, rise, number(1.0));
    return clamp(choose(rise > 0.0, newton, 0.5 * (*low + *high)), *low, *high);
}

OURS real locked_force(real speed, real free_speed, real sliding_force, real softness)
{
    real running = maximum(size_of(speed), number(SLOWEST_CREEP));
    return sliding_force * free_speed / (running + softness * sliding_force);
}

OURS real turning_direction(real rotation, real speed)
{
    real rolling = choose(speed < 0.0, number(-1.0), number(1.0));
    return choose(rotation > 0.0, number(1.0), choose(rotation < 0.0, number(-1.0), rolling));
}

#endif
