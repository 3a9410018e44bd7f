/* A controller behind uictest_controller.h with its variables in numbered places, as an FMU has them. */
#ifndef WSP_H
#define WSP_H

/* Written by build.py: PARAMETERS, their names and start values, INSTANTIATION_TOKEN. */
#include "parameters.h"
#include "uictest_controller.h"

#include <stdbool.h>

/* Value references of numbers; build.py has the same. */
enum {
    WHEEL_SPEED = 0,
    CYLINDER_PRESSURE = 4,
    BRAKE_DEMAND = 8,
    WHEEL_RADIUS = 9,
    INITIAL_SPEED = 13,
    CYCLE_TIME = 14,
    REFERENCE_SPEED = 15,
    TIME = 16,
    FIRST_PARAMETER = 17,
    NUMBERS = FIRST_PARAMETER + PARAMETERS
};

/* Value references of truth values and of the diagnosis. */
enum { SPEED_VALID = 1000, HOLD = 1004, VENT = 1008, DIAGNOSIS = 1012, END_OF_WHOLES = 1013 };

typedef struct {
    double numbers[NUMBERS];
    int32_t wholes[END_OF_WHOLES - SPEED_VALID];
    void *controller; /* NULL before it is initialised */
    int64_t cycle;
    char error[256];
} Wsp;

/* Set the start values of modelDescription.xml; drop the controller. */
void wsp_reset(Wsp *wsp);
/* Create the controller with the values set so far. False: wsp->error says why. */
bool wsp_start(Wsp *wsp);
/* Answer the inputs, which were read at a time, for a cycle of some length, s. False: wsp->error says why. */
bool wsp_step(Wsp *wsp, double time, double size);
/* The place of a variable, NULL if there is none. */
double *wsp_number(Wsp *wsp, unsigned reference);
int32_t *wsp_whole(Wsp *wsp, unsigned reference);

#endif
