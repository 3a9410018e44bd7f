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

/* Friction limit of one wheel and its slope with respect to slip speed. */
OURS real friction_limit(real slip_speed, real wheel_load, real initial_friction, real ratio, real decay, real *slope)
{
    real weight = wheel_load * initial_friction;
    real fading = weight * ((1.0 - ratio) * exponential(-decay * slip_speed));
    *slope = -decay * fading;
    return fma(weight, ratio, fading);
}

/* Gradient of the tangential stress as a quotient, and what has to be divided by it. */
typedef struct {
    real pull, hold, inverse_adhesion, inverse_slip, angle, tangent;
} Gradient;

OURS Gradient stress_gradient(real slip_speed, real speed, real limit, real stiffness, real reduction_adhesion,
                              real reduction_slip)
{
    Gradient g;
    g.pull = stiffness * slip_speed;
    g.hold = speed * limit;
    real adhering = reduction_adhesion * g.pull;
    real slipping = reduction_slip * g.pull;
    real hold_squared = g.hold * g.hold;
    real adhesion_part = fma(adhering, adhering, hold_squared);
    real slip_part = fma(slipping, slipping, hold_squared);
    real opposite, adjacent;
    g.angle = octant(slipping, g.hold, &opposite, &adjacent);
    real parts = adhesion_part * slip_part;
    real inverse = 1.0 / (parts * adjacent);
    real inverse_parts = inverse * adjacent;
    g.inverse_adhesion = slip_part * inverse_parts;
    g.inverse_slip = adhesion_part * inverse_parts;
    g.tangent = opposite * parts * inverse;
    return g;
}

OURS real force_and_slope(Gradient g, real speed, real limit, real limit_slope, real stiffness, real reduction_adhesion,
                          real reduction_slip, real *slope)
{
    real adhering = reduction_adhesion * g.pull;
    real shape = fma(adhering * g.hold, g.inverse_adhesion, g.angle + arctan_within_octant(g.tangent));
    real bend = fma(-adhering, adhering, g.hold * g.hold) * g.inverse_adhesion * g.inverse_adhesion;
    real shape_slope = fma(reduction_adhesion, bend, reduction_slip * g.inverse_slip);
    real quotient_slope = fma(stiffness, g.hold, -g.pull * speed * limit_slope);
    *slope = TWO_OVER_PI * fma(limit_slope, shape, limit * shape_slope * quotient_slope);
    return TWO_OVER_PI * limit * shape;
}

OURS real lowest_slip(real free_slip, real softness, real wheel_load, real initial_friction)
{
    return maximum(fma(-softness * 2.0 * wheel_load, initial_friction, free_slip), number(0.0));
}

/* One Newton step; narrows the bracket in place. */
OURS real refined_slip(real slip, real *low, real *high, real free_slip, real softness, real force, real slope)
{
    real residual = fma(softness * 2.0, force, slip - free_slip);
    real rise = fma(softness * 2.0, slope, 1.0);
    *high = choose(residual > 0.0, minimum(slip, *high), *high);
    *low = choose(residual > 0.0, *low, maximum(slip, *low));
    real newton = slip - residual / choose(rise > 0.0, rise, number(1.0));
    return clamp(choose(rise > 0.0, newton, 0.5 * (*low + *high)), *low, *high);
}

OURS real locked_force(real speed, real free_speed, real sliding_force, real softness)
{
    real running = maximum(size_of(speed), number(SLOWEST_CREEP));
    return sliding_force * free_speed / fma(softness, sliding_force, running);
}

OURS real turning_direction(real rotation, real speed)
{
    real rolling = choose(speed < 0.0, number(-1.0), number(1.0));
    return choose(rotation > 0.0, number(1.0), choose(rotation < 0.0, number(-1.0), rolling));
}

#endif
