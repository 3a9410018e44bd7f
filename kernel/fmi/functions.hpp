// The functions of FMI 2.0 and 3.0 for co-simulation: https://fmi-standard.org. Status numbers are the same in
// both. The arguments of a function that only says that it is not supported are left out: in the calling
// conventions of these systems the caller removes what it has passed.
#pragma once
#include "phases.hpp"

namespace {

enum Status : int { OK, ERROR_ = 3 };
typedef uint32_t Reference;
typedef void (*Logger2)(void*, const char*, int, const char*, const char*, ...);
typedef void (*Logger3)(void*, int, const char*, const char*);
struct Callbacks2 {
    Logger2 logger;
    void *allocate_memory, *free_memory, *step_finished, *environment;
};

// The logger of FMI 2.0 takes the message for a format, in which a percent sign is written twice.
void report2(const Instance* instance) {
    char format[2 * sizeof instance->message], *end = format;
    for (const char* sign = instance->message; *sign; ++sign) {
        if (*sign == '%') *end++ = '%';
        *end++ = *sign;
    }
    *end = 0;
    if (instance->logger) ((Logger2)instance->logger)(instance->environment, instance->name, ERROR_, "logStatusError", format);
}

void report3(const Instance* instance) {
    if (instance->logger) ((Logger3)instance->logger)(instance->environment, ERROR_, "logStatusError", instance->message);
}

Instance* caller(void (*report)(const Instance*), void* environment, void* logger) {
    Instance* instance = (Instance*)calloc(1, sizeof(Instance));
    if (instance) instance->report = report, instance->environment = environment, instance->logger = logger;
    return instance;
}

Instance* only_for_co_simulation(Instance* instance) {
    if (!instance) return nullptr;
    fail(instance, "this FMU is one for co-simulation only");
    instance->report(instance);
    destroy(instance);
    return nullptr;
}

int status_of(const Instance* instance, int succeeded) {
    if (succeeded) return OK;
    instance->report(instance);
    return ERROR_;
}

int not_supported(Instance* instance) {
    return status_of(instance, fail(instance, "this FMU does not support the function"));
}

template <class T> int get(Instance* instance, const Reference* references, size_t count, T* values, int64_t kind) {
    double number;
    for (size_t i = 0; i < count; ++i) {
        if (!get_value(instance, references[i], kind, number)) return status_of(instance, 0);
        values[i] = (T)number;
    }
    return OK;
}

template <class T> int set(Instance* instance, const Reference* references, size_t count, const T* values, int64_t kind) {
    for (size_t i = 0; i < count; ++i)
        if (!set_value(instance, references[i], kind, (double)values[i])) return status_of(instance, 0);
    return OK;
}

int get_state(Instance* instance, void** state) {
    if (!instance->model.head().can_save) return not_supported(instance);
    if (!*state && !(*state = malloc(instance->size())))
        return status_of(instance, fail(instance, "there is no memory for the state"));
    memcpy(*state, instance->state, instance->size());
    return OK;
}

int set_state(Instance* instance, const void* state) {
    if (!instance->model.head().can_save) return not_supported(instance);
    memcpy(instance->state, state, instance->size());
    return OK;
}

int free_state(Instance* instance, void** state) {
    if (!instance->model.head().can_save) return not_supported(instance);
    free(*state);
    *state = nullptr;
    return OK;
}
}

#define FUNCTION extern "C" EXPORT int
#define BOTH(NAME, ...) FUNCTION fmi2##NAME __VA_ARGS__ FUNCTION fmi3##NAME __VA_ARGS__
#define ACCESS(VERSION, NAME, TYPE, KIND, ROOM, COUNT)                                                                   \
    FUNCTION fmi##VERSION##Get##NAME(Instance* c, const Reference* references, size_t n, TYPE* values ROOM) {            \
        return get(c, references, COUNT, values, KIND);                                                                  \
    }                                                                                                                    \
    FUNCTION fmi##VERSION##Set##NAME(Instance* c, const Reference* references, size_t n, const TYPE* values ROOM) {      \
        return set(c, references, COUNT, values, KIND);                                                                  \
    }
#define ROOM3 , size_t room
#define ACCESS2(NAME, TYPE, KIND) ACCESS(2, NAME, TYPE, KIND, , n)
#define ACCESS3(NAME, TYPE, KIND) ACCESS(3, NAME, TYPE, KIND, ROOM3, n < room ? n : room)
#define UNSUPPORTED(NAME) FUNCTION NAME(Instance* c) { return not_supported(c); }
#define NO_VARIABLE(NAME) UNSUPPORTED(fmi3Get##NAME) UNSUPPORTED(fmi3Set##NAME)

BOTH(SetDebugLogging, (Instance*) { return OK; })  // only errors are logged, and always
BOTH(ExitInitializationMode, (Instance* c) { return status_of(c, exit_initialization(c)); })
BOTH(Terminate, (Instance* c) { c->state->phase = TERMINATED; return OK; })
BOTH(Reset, (Instance* c) { reset(c); return OK; })
extern "C" EXPORT void fmi2FreeInstance(Instance* c) { destroy(c); }
extern "C" EXPORT void fmi3FreeInstance(Instance* c) { destroy(c); }
extern "C" EXPORT const char* fmi2GetVersion(void) { return "2.0"; }
extern "C" EXPORT const char* fmi3GetVersion(void) { return "3.0"; }
extern "C" EXPORT const char* fmi2GetTypesPlatform(void) { return "default"; }

extern "C" EXPORT Instance* fmi2Instantiate(const char* name, int type, const char* token, const char* resources,
                                            const Callbacks2* functions, int, int) {
    Instance* c = caller(report2, functions ? functions->environment : nullptr, functions ? (void*)functions->logger : nullptr);
    return c && type == 1 ? instantiate(c, name, token, resources) : only_for_co_simulation(c);
}
extern "C" EXPORT Instance* fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources, bool,
                                                        bool, bool, bool, const Reference*, size_t, void* environment,
                                                        Logger3 logger, void*) {
    Instance* c = caller(report3, environment, (void*)logger);
    return c ? instantiate(c, name, token, resources) : nullptr;
}
extern "C" EXPORT Instance* fmi3InstantiateModelExchange(const char*, const char*, const char*, bool, bool,
                                                         void* environment, Logger3 logger) {
    return only_for_co_simulation(caller(report3, environment, (void*)logger));
}
extern "C" EXPORT Instance* fmi3InstantiateScheduledExecution(const char*, const char*, const char*, bool, bool,
                                                              void* environment, Logger3 logger) {
    return only_for_co_simulation(caller(report3, environment, (void*)logger));
}

FUNCTION fmi2SetupExperiment(Instance* c, int, double, double start_time, int, double) {
    c->state->start_time = start_time;
    return OK;
}
FUNCTION fmi2EnterInitializationMode(Instance* c) { return status_of(c, enter_initialization(c, c->state->start_time)); }
FUNCTION fmi3EnterInitializationMode(Instance* c, bool, double, double start_time, bool, double) {
    return status_of(c, enter_initialization(c, start_time));
}
FUNCTION fmi2DoStep(Instance* c, double point, double size, int) { return status_of(c, step(c, point, size)); }
FUNCTION fmi3DoStep(Instance* c, double point, double size, bool, bool* event_handling_needed, bool* terminate_simulation,
                    bool* early_return, double* last_time) {
    const int succeeded = step(c, point, size);
    *event_handling_needed = *terminate_simulation = *early_return = false;
    *last_time = c->time();
    return status_of(c, succeeded);
}

ACCESS2(Real, double, KIND_REAL)
ACCESS2(Integer, int, KIND_INTEGER)
ACCESS2(Boolean, int, KIND_BOOLEAN)
ACCESS3(Float64, double, KIND_REAL)
ACCESS3(Int64, int64_t, KIND_INTEGER)
ACCESS3(Boolean, bool, KIND_BOOLEAN)
FUNCTION fmi2GetString(Instance* c, const Reference*, size_t n) { return n ? not_supported(c) : OK; }
FUNCTION fmi2SetString(Instance* c, const Reference*, size_t n) { return n ? not_supported(c) : OK; }
FUNCTION fmi2GetFMUstate(Instance* c, void** state) { return get_state(c, state); }
FUNCTION fmi3GetFMUState(Instance* c, void** state) { return get_state(c, state); }
FUNCTION fmi2SetFMUstate(Instance* c, void* state) { return set_state(c, state); }
FUNCTION fmi3SetFMUState(Instance* c, void* state) { return set_state(c, state); }
FUNCTION fmi2FreeFMUstate(Instance* c, void** state) { return free_state(c, state); }
FUNCTION fmi3FreeFMUState(Instance* c, void** state) { return free_state(c, state); }

// Types that no variable has, what the model description says an FMU cannot do, and functions of other types of
// FMUs, which importing tools may look up nevertheless.
NO_VARIABLE(Float32) NO_VARIABLE(Int8) NO_VARIABLE(UInt8) NO_VARIABLE(Int16) NO_VARIABLE(UInt16) NO_VARIABLE(Int32)
NO_VARIABLE(UInt32) NO_VARIABLE(UInt64) NO_VARIABLE(String) NO_VARIABLE(Binary) NO_VARIABLE(Clock)
NO_VARIABLE(IntervalDecimal) NO_VARIABLE(IntervalFraction) NO_VARIABLE(ShiftDecimal) NO_VARIABLE(ShiftFraction)
BOTH(GetDirectionalDerivative, (Instance* c) { return not_supported(c); })
UNSUPPORTED(fmi2SerializedFMUstateSize) UNSUPPORTED(fmi2SerializeFMUstate) UNSUPPORTED(fmi2DeSerializeFMUstate)
UNSUPPORTED(fmi2SetRealInputDerivatives) UNSUPPORTED(fmi2GetRealOutputDerivatives) UNSUPPORTED(fmi2CancelStep)
UNSUPPORTED(fmi2GetStatus) UNSUPPORTED(fmi2GetRealStatus) UNSUPPORTED(fmi2GetIntegerStatus)
UNSUPPORTED(fmi2GetBooleanStatus) UNSUPPORTED(fmi2GetStringStatus)
UNSUPPORTED(fmi3GetNumberOfVariableDependencies) UNSUPPORTED(fmi3GetVariableDependencies)
UNSUPPORTED(fmi3SerializedFMUStateSize) UNSUPPORTED(fmi3SerializeFMUState) UNSUPPORTED(fmi3DeserializeFMUState)
UNSUPPORTED(fmi3GetAdjointDerivative) UNSUPPORTED(fmi3UpdateDiscreteStates) UNSUPPORTED(fmi3GetOutputDerivatives)
UNSUPPORTED(fmi3CompletedIntegratorStep) UNSUPPORTED(fmi3SetTime) UNSUPPORTED(fmi3SetContinuousStates)
UNSUPPORTED(fmi3GetContinuousStateDerivatives) UNSUPPORTED(fmi3GetEventIndicators) UNSUPPORTED(fmi3GetContinuousStates)
UNSUPPORTED(fmi3GetNominalsOfContinuousStates) UNSUPPORTED(fmi3GetNumberOfEventIndicators)
UNSUPPORTED(fmi3GetNumberOfContinuousStates) UNSUPPORTED(fmi3ActivateModelPartition) UNSUPPORTED(fmi3EnterEventMode)
UNSUPPORTED(fmi3EnterStepMode) UNSUPPORTED(fmi3EnterContinuousTimeMode) UNSUPPORTED(fmi3EnterConfigurationMode)
UNSUPPORTED(fmi3ExitConfigurationMode) UNSUPPORTED(fmi3EvaluateDiscreteStates)
