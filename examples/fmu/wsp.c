#include "wsp.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void wsp_reset(Wsp *wsp)
{
    if (wsp->controller != NULL)
        uictest_destroy(wsp->controller);
    memset(wsp, 0, sizeof *wsp);
    wsp->numbers[CYCLE_TIME] = 0.01;
    for (int i = 0; i < UICTEST_WHEELSETS; i++) {
        wsp->numbers[WHEEL_RADIUS + i] = 0.46;
        wsp->wholes[i] = 1; /* speed_valid */
    }
    memcpy(wsp->numbers + FIRST_PARAMETER, PARAMETER_VALUES, PARAMETERS * sizeof(double));
}

static bool failed(Wsp *wsp, const char *function)
{
    const char *reason = uictest_last_error(wsp->controller);
    snprintf(wsp->error, sizeof wsp->error, "%s failed: %s", function, reason ? reason : "no reason given");
    return false;
}

/* Write the parameters as the JSON object that a controller is given; 17 digits keep every bit. */
static void write_json(const Wsp *wsp, char *json)
{
    json += sprintf(json, "{");
    for (int i = 0; i < PARAMETERS; i++)
        json += sprintf(json, "%s\"%s\": %.17g", i ? ", " : "", PARAMETER_NAMES[i],
                        wsp->numbers[FIRST_PARAMETER + i]);
    sprintf(json, "}");
}

bool wsp_start(Wsp *wsp)
{
    char json[PARAMETERS * (LONGEST_PARAMETER_NAME + 32) + 3];
    uictest_config config = {
        .wheelsets = UICTEST_WHEELSETS,
        .cycle_time = wsp->numbers[CYCLE_TIME],
        .initial_speed = wsp->numbers[INITIAL_SPEED],
        .parameters = json,
    };
    write_json(wsp, json);
    memcpy(config.wheel_radius, wsp->numbers + WHEEL_RADIUS, sizeof config.wheel_radius);
    wsp->controller = uictest_create(&config);
    if (wsp->controller == NULL)
        return failed(wsp, "uictest_create");
    return uictest_reset(wsp->controller) == 0 || failed(wsp, "uictest_reset");
}

bool wsp_step(Wsp *wsp, double time, double size)
{
    uictest_inputs inputs = {
        .cycle = wsp->cycle++, .time = time, .brake_demand = wsp->numbers[BRAKE_DEMAND]};
    uictest_outputs outputs = {.reference_speed = NAN};
    memcpy(inputs.wheel_speed, wsp->numbers + WHEEL_SPEED, sizeof inputs.wheel_speed);
    memcpy(inputs.cylinder_pressure, wsp->numbers + CYLINDER_PRESSURE, sizeof inputs.cylinder_pressure);
    memcpy(inputs.speed_valid, wsp_whole(wsp, SPEED_VALID), sizeof inputs.speed_valid);
    if (uictest_step(wsp->controller, &inputs, &outputs) != 0)
        return failed(wsp, "uictest_step");
    memcpy(wsp_whole(wsp, HOLD), outputs.hold, sizeof outputs.hold);
    memcpy(wsp_whole(wsp, VENT), outputs.vent, sizeof outputs.vent);
    *wsp_whole(wsp, DIAGNOSIS) = (int32_t)outputs.diagnosis;
    wsp->numbers[TIME] = time + size;
    wsp->numbers[REFERENCE_SPEED] = outputs.reference_speed;
    return true;
}

double *wsp_number(Wsp *wsp, unsigned reference)
{
    return reference < NUMBERS ? &wsp->numbers[reference] : NULL;
}

int32_t *wsp_whole(Wsp *wsp, unsigned reference)
{
    bool is_there = reference >= SPEED_VALID && reference < END_OF_WHOLES;
    return is_there ? &wsp->wholes[reference - SPEED_VALID] : NULL;
}
