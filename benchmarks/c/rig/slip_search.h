/* Search for the slip speeds at the end of a step: nothing of it outlasts the step. */
#ifndef SLIP_SEARCH_H
#define SLIP_SEARCH_H

#include "../physics/contact.h"
#include "records.h"

#define HIGHEST_LOAD 2.5

/* Slip speed of one wheelset, as far as it has been found, and the creep at its estimate. */
typedef struct {
    real direction, free, lowest, highest, estimate;
    real friction_limit, limit_slope;
    Gradient gradient;
} Slip;

OURS Slip bracket_slip(Wheelset *wheelset, real thrust, const Parameters *p)
{
    Slip s;
    real load_ratio = minimum(wheelset->wheel_load * p->load_scale, number(HIGHEST_LOAD));
    wheelset->contact_stiffness = contact_stiffness(p->creep_stiffness, load_ratio);
    real slip = fma(-wheelset->wheel_radius, wheelset->rotation, wheelset->speed);
    real braking = turning_direction(wheelset->rotation, wheelset->speed) * wheelset->torque;
    real pushed = fma(p->mass_response, thrust, slip);
    real free_slip = fma(wheelset->inertia_response * wheelset->wheel_radius, braking, pushed);
    s.direction = choose(free_slip < 0.0, number(-1.0), number(1.0));
    s.free = s.direction * free_slip;
    s.highest = s.free;
    s.lowest = lowest_slip(s.free, wheelset->slip_response, wheelset->wheel_load, wheelset->friction);
    s.estimate = maximum(s.direction * slip, number(0.0));
    return s;
}

OURS void find_friction_limit(Slip *s, const Wheelset *wheelset, const Parameters *p)
{
    s->friction_limit = friction_limit(s->estimate, wheelset->wheel_load, wheelset->friction, wheelset->friction_ratio,
                                       wheelset->friction_decay, &s->limit_slope);
}

OURS void find_stress_gradient(Slip *s, const Wheelset *wheelset, const Parameters *p)
{
    s->gradient = stress_gradient(s->estimate, maximum(size_of(wheelset->speed), number(SLOWEST_CREEP)),
                                  s->friction_limit, wheelset->contact_stiffness, wheelset->reduction_adhesion,
                                  wheelset->reduction_slip);
}

/* One Newton step towards the slip speed; returns the creep force of both wheels before it. */
OURS real refine_slip(Slip *s, const Wheelset *wheelset, const Parameters *p)
{
    real slope;
    real force = force_and_slope(s->gradient, maximum(size_of(wheelset->speed), number(SLOWEST_CREEP)),
                                 s->friction_limit, s->limit_slope, wheelset->contact_stiffness, wheelset->reduction_adhesion,
                                 wheelset->reduction_slip, &slope);
    s->estimate =
        refined_slip(s->estimate, &s->lowest, &s->highest, s->free, wheelset->slip_response, force, slope);
    return 2.0 * force;
}

OURS void find_creep(Slip *slips, const Wheelset *wheelsets, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        find_friction_limit(&slips[i], &wheelsets[i], p);
    for (int i = 0; i < 4; i++)
        find_stress_gradient(&slips[i], &wheelsets[i], p);
}

/* Two Newton steps for each wheelset; the first finds the force at the last slip speed. */
OURS void find_slips(Slip *slips, real *sliding_forces, Wheelset *wheelsets, const real *thrusts, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        slips[i] = bracket_slip(&wheelsets[i], thrusts[i], p);
    find_creep(slips, wheelsets, p);
    for (int i = 0; i < 4; i++)
        sliding_forces[i] = refine_slip(&slips[i], &wheelsets[i], p);
    find_creep(slips, wheelsets, p);
    for (int i = 0; i < 4; i++)
        refine_slip(&slips[i], &wheelsets[i], p);
}

#endif
