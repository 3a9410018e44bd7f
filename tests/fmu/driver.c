/* Steps an FMU: driver VERSION LIBRARY TOKEN RESOURCES CYCLE, then on standard input, with value references,
 *   r REFERENCE VALUE, b REFERENCE VALUE    set a number or a truth value
 *   s                                       step
 *   g REFERENCE                             print the bits of a number
 * With STATIC the library is linked with it. What only FMI 3.0 has behind the arguments of FMI 2.0 is passed to both. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef STATIC
#define DECLARED(NAME) void *NAME(void);
#define FUNCTION(NAME) (void *)NAME
#elif defined(_WIN32)
#include <windows.h>
#define DECLARED(NAME)
#define FUNCTION(NAME) (void *)GetProcAddress(library, #NAME)
#else
#include <dlfcn.h>
#define DECLARED(NAME)
#define FUNCTION(NAME) dlsym(library, #NAME)
#endif
#define BOTH(NAME) DECLARED(fmi2##NAME) DECLARED(fmi3##NAME)
BOTH(EnterInitializationMode) BOTH(ExitInitializationMode) BOTH(DoStep) BOTH(SetBoolean) BOTH(FreeInstance)
DECLARED(fmi2Instantiate) DECLARED(fmi3InstantiateCoSimulation) DECLARED(fmi2SetupExperiment)
DECLARED(fmi2GetReal) DECLARED(fmi3GetFloat64) DECLARED(fmi2SetReal) DECLARED(fmi3SetFloat64)
#define OF(NAME) (version == 2 ? FUNCTION(fmi2##NAME) : FUNCTION(fmi3##NAME))

typedef int Access(void *, const unsigned *, size_t, void *, size_t);

static void log2(void *environment, const char *name, int status, const char *category, const char *message, ...)
{
    (void)environment, (void)name, (void)status, (void)category;
    printf("%s\n", message);
}

static void log3(void *environment, int status, const char *category, const char *message)
{
    (void)environment, (void)status, (void)category;
    printf("%s\n", message);
}

static void *instantiate(int version, void *function, char **arguments)
{
    struct { void *logger, *others[3], *environment; } callbacks = {(void *)log2, {0}, NULL};
    void *(*two)(const char *, int, const char *, const char *, void *, int, int) = function;
    void *(*three)(const char *, const char *, const char *, int, int, int, int, void *, size_t, void *, void *,
                   void *) = function;
    return version == 2 ? two("driven", 1, arguments[3], arguments[4], &callbacks, 0, 0)
                        : three("driven", arguments[3], arguments[4], 0, 0, 0, 0, NULL, 0, NULL, (void *)log3, NULL);
}

int main(int count, char **arguments)
{
    int version = count == 6 ? atoi(arguments[1]) : 0;
#ifdef STATIC
#elif defined(_WIN32)
    HMODULE library = LoadLibraryA(arguments[2]);
    if (!library) return printf("not loaded: %lu\n", GetLastError()), 2;
#else
    void *library = dlopen(arguments[2], RTLD_NOW);
    if (!library) return puts(dlerror()), 2;
#endif
    void *c = instantiate(version, version == 2 ? FUNCTION(fmi2Instantiate) : FUNCTION(fmi3InstantiateCoSimulation),
                          arguments);
    if (!c) return 1;
    if (version == 2) ((int (*)(void *, int, double, double, int, double))FUNCTION(fmi2SetupExperiment))(c, 0, 0, 0, 0, 0);
    ((int (*)(void *, int, double, double, int, double))OF(EnterInitializationMode))(c, 0, 0.0, 0.0, 0, 0.0);
    ((int (*)(void *))OF(ExitInitializationMode))(c);
    Access *get = (Access *)(version == 2 ? FUNCTION(fmi2GetReal) : FUNCTION(fmi3GetFloat64));
    Access *set = (Access *)(version == 2 ? FUNCTION(fmi2SetReal) : FUNCTION(fmi3SetFloat64));
    Access *set_truth = (Access *)OF(SetBoolean);
    int (*step)(void *, double, double, int, void *, void *, void *, void *) = OF(DoStep);
    double cycle = atof(arguments[5]), value, last;
    unsigned reference;
    unsigned long long bits;
    char command, flags[3];
    for (long steps = 0; scanf(" %c", &command) == 1;) {
        if (command == 's') {
            if (step(c, steps++ * cycle, cycle, 0, flags, flags + 1, flags + 2, &last)) return 1;
        } else if (command == 'g' && scanf("%u", &reference) == 1) {
            if (get(c, &reference, 1, &value, 1)) return 1;
            memcpy(&bits, &value, sizeof bits);
            printf("%016llx\n", bits);
        } else if (scanf("%u %lf", &reference, &value) == 2) {
            int truth = value != 0.0;
            if (command == 'r' ? set(c, &reference, 1, &value, 1) : set_truth(c, &reference, 1, &truth, 1)) return 1;
        }
    }
    ((void (*)(void *))OF(FreeInstance))(c);
    return 0;
}
