/* An FMU of FMI 2.0 or 3.0 (-DFMI=2, 3) whose variables may have any type: a value reference is a place for a
 * number. It vents wheelsets slower than `threshold`, and does in step `at` what `fault` says. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if FMI == 2
#include "fmi2Functions.h"
#define NAME(name) fmi2##name
#define COUNT
#else
#include "fmi3Functions.h"
#define NAME(name) fmi3##name
#define COUNT , size_t m
#endif
#define STATUS NAME(Status)
#define REFERENCE NAME(ValueReference)
#define SIZE(reference) ((reference) < ARRAYS ? 1u : 4u) /* 100 + place: an array of four */

enum { SPEED = 0, TIME = 13, HOLD = 21, VENT = 25, REFERENCE_SPEED = 29, DIAGNOSIS = 30, FAULT = 31, AT = 32,
       THRESHOLD = 33, LATE = 34, PLACES = 64, ARRAYS = 100 };
enum { NO_FAULT, NAN_HOLD, HALF_VENT, ERROR_STEP, FATAL_STEP, END, FORBIDDEN, NAN_DIAGNOSIS, ERROR_START,
       ERROR_RESET, FATAL_RESET };

typedef struct {
    double place[PLACES];
    int steps;
    int vented[4];
    char text[64];
#if FMI == 2
    const fmi2CallbackFunctions *callbacks;
#else
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
#endif
} Instance;

static int instances; /* ever made of this copy of the library */

static STATUS logged(Instance *own, STATUS status, const char *message)
{
#if FMI == 2
    own->callbacks->logger(own->callbacks->componentEnvironment, "any", status, "error", "%s %d", message, 7);
#else
    own->log(own->environment, status, "error", message);
#endif
    return status;
}

static void begin(Instance *own)
{
    memset(own->place, 0, sizeof own->place);
    own->place[AT] = 100;
    own->steps = 0;
    memset(own->vented, 0, sizeof own->vented);
    strcpy(own->text, "start");
}

static STATUS stepped(Instance *own, int *ends)
{
    int fault = own->steps++ == (int)own->place[AT] ? (int)own->place[FAULT] : NO_FAULT;
    for (int i = 0; i < 4; i++) {
        int vented = own->place[SPEED + i] < own->place[THRESHOLD];
        own->place[HOLD + i] = own->place[VENT + i] = own->place[LATE] ? own->vented[i] : vented;
        own->vented[i] = vented;
    }
    own->place[REFERENCE_SPEED] = own->place[TIME];
    own->place[DIAGNOSIS] = instances;
    if (fault == NAN_HOLD)
        own->place[HOLD + 2] = NAN;
    if (fault == HALF_VENT)
        own->place[VENT + 1] = 0.5;
    if (fault == FORBIDDEN)
        own->place[HOLD + 3] = 0, own->place[VENT + 3] = 1;
    if (fault == NAN_DIAGNOSIS)
        own->place[DIAGNOSIS] = NAN;
    *ends = fault == END;
    if (fault == ERROR_STEP)
        return logged(own, NAME(Error), "told to");
    return fault == FATAL_STEP ? NAME(Fatal) : NAME(OK);
}

static STATUS started(Instance *own)
{
    return own->place[FAULT] == ERROR_START ? logged(own, NAME(Error), "no start") : NAME(OK);
}

#define ACCESS(Type, ctype)                                                                                 \
    STATUS NAME(Set##Type)(void *own, const REFERENCE *vr, size_t n, const ctype *values COUNT)             \
    {                                                                                                       \
        for (size_t i = 0, k = 0; i < n; i++)                                                               \
            for (size_t element = 0; element < SIZE(vr[i]); element++)                                      \
                ((Instance *)own)->place[vr[i] % ARRAYS + element] = (double)values[k++];                   \
        return NAME(OK);                                                                                    \
    }                                                                                                       \
    STATUS NAME(Get##Type)(void *own, const REFERENCE *vr, size_t n, ctype *values COUNT)                   \
    {                                                                                                       \
        for (size_t i = 0, k = 0; i < n; i++)                                                               \
            for (size_t element = 0; element < SIZE(vr[i]); element++)                                      \
                values[k++] = (ctype)((Instance *)own)->place[vr[i] % ARRAYS + element];                    \
        return NAME(OK);                                                                                    \
    }

STATUS NAME(SetString)(void *own, const REFERENCE *vr, size_t n, const NAME(String) * values COUNT)
{
    (void)vr, (void)n;
    /* The text sets the threshold: its length in m/s. */
    ((Instance *)own)->place[THRESHOLD] = (double)strlen(values[0]);
    return NAME(OK);
}

void NAME(FreeInstance)(void *own) { free(own); }
const char *NAME(GetVersion)(void) { return FMI == 2 ? "2.0" : "3.0"; }
STATUS NAME(ExitInitializationMode)(void *own) { return started(own); }
STATUS NAME(Terminate)(void *own) { return (void)own, NAME(OK); }
STATUS NAME(Reset)(void *own)
{
    int fault = (int)((Instance *)own)->place[FAULT];
    if (fault == ERROR_RESET || fault == FATAL_RESET)
        return logged(own, fault == ERROR_RESET ? NAME(Error) : NAME(Fatal), "no reset");
    return begin(own), NAME(OK);
}

#if FMI == 2
ACCESS(Real, double)
ACCESS(Integer, int)
ACCESS(Boolean, int)
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean log)
{
    (void)name, (void)type, (void)resources, (void)visible, (void)log;
    if (strcmp(token, "right") != 0)
        return NULL;
    Instance *own = calloc(1, sizeof *own);
    own->callbacks = callbacks;
    instances++;
    begin(own);
    return own;
}
fmi2Status fmi2SetupExperiment(void *own, int a, double b, double c, int d, double e)
{
    return (void)own, (void)a, (void)b, (void)c, (void)d, (void)e, fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(void *own) { return (void)own, fmi2OK; }
fmi2Status fmi2DoStep(void *own, double time, double size, fmi2Boolean no_earlier_state)
{
    int ends;
    (void)time, (void)size, (void)no_earlier_state;
    return stepped(own, &ends);
}
#else
ACCESS(Float32, float)
ACCESS(Float64, double)
ACCESS(Int8, int8_t)
ACCESS(UInt8, uint8_t)
ACCESS(Int16, int16_t)
ACCESS(UInt16, uint16_t)
ACCESS(Int32, int32_t)
ACCESS(UInt32, uint32_t)
ACCESS(Int64, int64_t)
ACCESS(UInt64, uint64_t)
ACCESS(Boolean, fmi3Boolean)
fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode, fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t n,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early_return;
    (void)intermediate, (void)n, (void)update;
    if (strcmp(token, "right") != 0)
        return NULL;
    Instance *own = calloc(1, sizeof *own);
    own->log = log;
    own->environment = environment;
    instances++;
    begin(own);
    return own;
}
fmi3Status fmi3EnterInitializationMode(void *own, fmi3Boolean a, double b, double c, fmi3Boolean d, double e)
{
    return (void)own, (void)a, (void)b, (void)c, (void)d, (void)e, fmi3OK;
}
fmi3Status fmi3DoStep(void *own, double time, double size, fmi3Boolean no_earlier_state, fmi3Boolean *event,
                      fmi3Boolean *terminate, fmi3Boolean *early, double *last)
{
    int ends;
    fmi3Status status = stepped(own, &ends);
    (void)no_earlier_state;
    *event = *early = fmi3False;
    *terminate = ends;
    *last = time + size;
    return status;
}
#endif
