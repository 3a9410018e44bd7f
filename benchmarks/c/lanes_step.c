/* The base steps of a controller cycle, LANES stops side by side. */
#include "rig/step.h"

extern "C" void steps_in_lanes(Car *car, Bogie *bogies, Wheelset *wheelsets, const Parameters *p, int64_t steps)
{
    for (int64_t k = 0; k < steps; k++)
        step(car, bogies, wheelsets, p);
}
