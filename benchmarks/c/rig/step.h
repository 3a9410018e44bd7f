/* One base step of the whole rig. */
#ifndef STEP_H
#define STEP_H

#include "clamping.h"
#include "pneumatics.h"
#include "running_gear.h"

OURS void step_vehicle(Car *car, Bogie *bogies, Wheelset *wheelsets, const Parameters *p)
{
    CLEAR_FORCES(car);
    CLEAR_FORCES(&bogies[0]);
    CLEAR_FORCES(&bogies[1]);
    couple_body(car, &bogies[0], p);
    couple_body(car, &bogies[1], p);
    real thrusts[4], sliding_forces[4];
    Braking braking[4];
    Slip slips[4];
    for (int i = 0; i < 4; i++)
        thrusts[i] = couple_wheelset(&wheelsets[i], &bogies[i / 2], car, p);
    find_slips(slips, sliding_forces, wheelsets, thrusts, p);
    for (int i = 0; i < 4; i++)
        braking[i] = step_wheelset(&wheelsets[i], &bogies[i / 2], thrusts[i], sliding_forces[i], &slips[i], p);
    for (int j = 0; j < 2; j++)
        STEP_FRAME(&bogies[j], p->bogie_mass, p->bogie_mass_response, p->bogie_pitch_response, number(0.0), p);
    for (int i = 0; i < 4; i++)
        account_for_brakes(&wheelsets[i], &bogies[i / 2], braking[i], p);
    step_body(car, p);
}

OURS void step(Car *car, Bogie *bogies, Wheelset *wheelsets, const Parameters *p)
{
    step_air(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        step_clamping(&wheelsets[i], p);
    step_vehicle(car, bogies, wheelsets, p);
    car->steps += 1.0;
    car->vehicle_steps += 1.0;
    car->substep += 1.0;
    car->time = car->steps * p->step;
}

#endif
