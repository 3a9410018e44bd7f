/* The rig of one case behind the functions of FMI: what fmi2.c and fmi3.c have in common.
 *
 * case.h is generated with every FMU: the case's records as numbers, the layout of a stop's memory, and where
 * each variable lies in it. The machine code of the rig is linked with these files.
 */
#ifndef UICTEST_RIG_H
#define UICTEST_RIG_H

#include <stddef.h>
#include <stdint.h>

#include "case.h"

#define EXPORT __attribute__((visibility("default")))

/* Everything that changes in a stop. It holds no address: a copy of it is a copy of the stop. */
typedef struct {
    uint64_t memory[MEMORY_SIZE / 8];
    enum { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED } phase;
    double start_time;
    int64_t steps; /* since start_time */
} State;

typedef struct {
    State state;
    char message[200]; /* why the last function failed */
    char *name;
    void *environment; /* of the caller, for its logger */
    void (*logger)(void);
} Rig;

/* Return why no instance can be made, or NULL. */
const char *why_unusable(const char *token);
/* Create an instance as it is before its initialization, NULL if memory is short. */
Rig *create_rig(const char *name, void *environment, void (*logger)(void));
void free_rig(Rig *rig);
void reset_rig(Rig *rig);

/* The following return 1, or 0 with a message. */
int enter_initialization(Rig *rig, double start_time);
int exit_initialization(Rig *rig);
int terminate(Rig *rig);
/* Carry out the commands from a communication point on, for one controller cycle. */
int step_rig(Rig *rig, double communication_point, double step_size);
int get_value(Rig *rig, uint32_t reference, Kind kind, double *value);
int set_value(Rig *rig, uint32_t reference, Kind kind, double value);
int fail(Rig *rig, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
