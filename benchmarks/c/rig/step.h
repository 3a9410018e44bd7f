/* One base step of the whole rig. */
#ifndef STEP_H
#define STEP_H

#include "clamping.h"
#include "pneumatics.h"
#include "running_gear.h"

OURS void find_creep(Wheelset *wheelsets, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        find_friction_limit(&wheelsets[i], p);
    for (int i = 0; i < 4; i++)
        find_stress_gradient(&wheelsets[i], p);
}

OURS void step_vehicle(Car *car, Bogie *bogies, Wheelset *wheelsets, const Parameters *p)
{
    CLEAR_FORCES(car);
    CLEAR_FORCES(&bogies[0]);
    CLEAR_FORCES(&bogies[1]);
    couple_body(car, &bogies[0], p);
    couple_body(car, &bogies[1], p);
    for (int i = 0; i < 4; i++)
        couple_wheelset(&wheelsets[i], &bogies[i / 2], car, p);
    for (int i = 0; i < 4; i++)
        bracket_slip(&wheelsets[i], p);
    find_creep(wheelsets, p);
    for (int i = 0; i < 4; i++)
        wheelsets[i].sliding_force = refine_slip(&wheelsets[i], p);
    find_creep(wheelsets, p);
    for (int i = 0; i < 4; i++)
        refine_slip(&wheelsets[i], p);
    for (int i = 0; i < 4; i++)
        step_wheelset(&wheelsets[i], &bogies[i / 2], p);
    for (int j = 0; j < 2; j++)
        STEP_FRAME(&bogies[j], p->bogie_mass, p->bogie_mass_response, p->bogie_pitch_response, number(0.0), p);
    for (int i = 0; i < 4; i++)
        heat_disc(&wheelsets[i], &bogies[i / 2], p);
    step_body(car, p);
}

OURS void step(Car *car, Bogie *bogies, Wheelset *wheelsets, const Parameters *p)
{
    step_air(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        step_clamping(&wheelsets[i], p);
    step_vehicle(car, bogies, wheelsets, p);
    car->steps += 1.0;
    car->substep += 1.0;
    car->time = car->steps * p->step;
}

#endif
