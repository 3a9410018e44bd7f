/* An instance behind the functions of FMI: what fmi2.c and fmi3.c call, and what rig.c and controller.c do.
 *
 * model.h is generated with every FMU: the memory of an instance, and where each variable lies in it.
 */
#ifndef UICTEST_INSTANCE_H
#define UICTEST_INSTANCE_H

#include <stddef.h>
#include <stdint.h>

typedef enum { REAL, BOOLEAN, INTEGER } Kind;
typedef enum { INDEPENDENT, INPUT, OUTPUT, PARAMETER } Causality;
typedef enum { FLOAT64, INT32, INT64 } Storage;
typedef struct {
    const char *name;
    Kind kind;
    Causality causality;
    Storage storage;
    size_t offset;
    double lowest, highest; /* of a parameter */
} Variable;

#include "model.h"

#define LONGEST_MESSAGE 400
#define EXPORT __attribute__((visibility("default")))

/* Everything that changes in a simulation. Where CAN_SAVE is 1 it holds no address: a copy of it is a copy of
 * the simulation. */
typedef struct {
    uint64_t memory[(MEMORY_SIZE + 7) / 8];
    enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED } phase;
    double start_time;
    int64_t steps; /* since start_time */
} State;

typedef struct {
    State state;
    char message[LONGEST_MESSAGE]; /* why the last function failed */
    char *name;
    void *environment; /* of the caller, for its logger */
    void (*logger)(void);
    void *controller; /* NULL where there is none */
} Instance;

/* Return why no instance can be made, or NULL. */
const char *why_unusable(const char *token);
/* Create an instance as it is before its initialization, NULL if memory is short. */
Instance *create_instance(const char *name, void *environment, void (*logger)(void));
void free_instance(Instance *instance);
void reset_instance(Instance *instance);

/* The following return 1, or 0 with a message. */
int enter_initialization(Instance *instance, double start_time);
int exit_initialization(Instance *instance);
int terminate(Instance *instance);
/* Carry out one controller cycle from a communication point on. */
int step_instance(Instance *instance, double communication_point, double step_size);
int get_value(Instance *instance, uint32_t reference, Kind kind, double *value);
int set_value(Instance *instance, uint32_t reference, Kind kind, double value);
int fail(Instance *instance, const char *format, ...) __attribute__((format(printf, 2, 3)));

void *at(Instance *instance, size_t offset);
double instance_time(const Instance *instance);

/* What rig.c and controller.c define. */
const char *why_not_on_this_machine(void);
double cycle_time(const Instance *instance);
/* Fill the memory, which is zeroed. */
void set_start_values(Instance *instance);
/* Begin when the initialization is entered, and anew when a parameter is set in it. */
void begin(Instance *instance);
/* Leave the initialization; return 1, or 0 with a message. So does a step. */
int complete(Instance *instance);
int carry_out(Instance *instance);
void release(Instance *instance);

#endif
