/* The base steps of a controller cycle, LANES stops side by side. */
#include "rig/step.h"

extern "C" void steps_in_lanes(Car *__restrict car, Bogie *__restrict bogies, Wheelset *__restrict wheelsets,
                               const Parameters *__restrict p, int64_t steps)
{
    for (int64_t k = 0; k < steps; k++)
        step(car, bogies, wheelsets, p);
}
