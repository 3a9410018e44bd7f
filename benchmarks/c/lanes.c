/* Many stops in STRIDE lanes: a lane whose stop has ended takes the next one.
 *
 * Sensors, controllers and measures are scalar and work on the lanes in place: here the fields of a state lie STRIDE numbers
 * apart, so that a pointer to the first number of a lane is one to its state. All stops have the same base step and
 * controller cycle.
 */
#include <stdlib.h>
#include <string.h>

#include "rig/cycle.h"
#include "rig/observation.h"
#include "rig/start.h"

typedef struct {
    Car car;
    Bogie bogies[2];
    Wheelset wheelsets[4];
} State;

#define NUMBERS(type) (sizeof(type) / sizeof(double))
typedef double Lanes[STRIDE];

void steps_in_lanes(Lanes *car, Lanes *bogies, Lanes *wheelsets, const Lanes *p, int64_t steps);

static void put(Lanes *lanes, int lane, const void *record, size_t numbers)
{
    for (size_t i = 0; i < numbers; i++)
        memcpy(&lanes[i][lane], (const char *)record + i * sizeof(double), sizeof(double));
}

static State *state_in(Lanes *lanes, int lane) { return (State *)&lanes[0][lane]; }

static void clear(Lanes *lanes, int lane)
{
    for (size_t i = 0; i < NUMBERS(State) / STRIDE; i++)
        lanes[i][lane] = 0.0;
}

typedef struct {
    int64_t stop; /* number of the stop in this lane; -1 when none is left */
} Place;

typedef struct {
    int64_t count, next;
    const Parameters *parameters;
    const WheelsetParameters *wheelset_parameters; /* four of each stop */
    const double *rails; /* friction laws of one point, four numbers per stop */
    Measures *measures;
    WheelsetMeasures *wheelset_measures;
} Work;

static void take_next(Work *work, Place *place, Lanes *lanes, Lanes *parameters, int lane)
{
    place->stop = work->next < work->count ? work->next++ : -1;
    if (place->stop < 0)
        return;
    const Parameters *p = &work->parameters[place->stop];
    State *state = state_in(lanes, lane);
    clear(lanes, lane);
    start(&state->car, state->bogies, state->wheelsets, p, &work->wheelset_parameters[4 * place->stop]);
    begin_stop_measures(&state->car, &work->measures[place->stop], &work->wheelset_measures[4 * place->stop], p);
    put(parameters, lane, p, NUMBERS(Parameters));
}

/* Close a cycle of one lane; refill the lane when its stop has ended. */
static void end_cycle(Work *work, Place *place, Lanes *lanes, Lanes *parameters, int lane)
{
    const Parameters *p = &work->parameters[place->stop];
    State *state = state_in(lanes, lane);
    Measures *measures = &work->measures[place->stop];
    WheelsetMeasures *wheelset_measures = &work->wheelset_measures[4 * place->stop];
    observe_cycle(&state->car, state->wheelsets, measures, wheelset_measures, p);
    if (state->car.stopped == 0.0 && state->car.cycle < p->cycles)
        return;
    close_stop_measures(&state->car, state->bogies, state->wheelsets, measures, wheelset_measures, p);
    take_next(work, place, lanes, parameters, lane);
}

static void start_cycle_of_stop(const Work *work, const Place *place, State *state)
{
    Rail laws = {work->rails + 4 * place->stop, 1};
    const Parameters *p = &work->parameters[place->stop];
    read_sensors(&state->car, state->wheelsets, p);
    start_cycle(&state->car, state->wheelsets, p, laws);
}

void stops(int64_t count, const Parameters *parameters, const WheelsetParameters *wheelset_parameters,
           const double *rails, Measures *measures, WheelsetMeasures *wheelset_measures)
{
    Work work = {count, 0, parameters, wheelset_parameters, rails, measures, wheelset_measures};
    Lanes *lanes = aligned_alloc(64, sizeof(State));
    Lanes *lane_parameters = aligned_alloc(64, NUMBERS(Parameters) * sizeof(Lanes));
    State *all = (State *)lanes;
    Lanes *car = (Lanes *)&all->car, *bogies = (Lanes *)all->bogies, *wheelsets = (Lanes *)all->wheelsets;
    Place places[STRIDE];
    int64_t steps = parameters[0].steps_per_cycle, busy = 0;
    for (int lane = 0; lane < STRIDE; lane++) {
        take_next(&work, &places[lane], lanes, lane_parameters, lane);
        if (places[lane].stop < 0) { /* fewer stops than lanes: an idle lane stands still unseen */
            clear(lanes, lane);
            put(lane_parameters, lane, &parameters[count - 1], NUMBERS(Parameters));
        } else {
            start_cycle_of_stop(&work, &places[lane], state_in(lanes, lane));
            busy++;
        }
    }
    while (busy > 0) {
        steps_in_lanes(car, bogies, wheelsets, lane_parameters, steps);
        for (int lane = 0; lane < STRIDE; lane++) {
            if (places[lane].stop < 0)
                continue;
            end_cycle(&work, &places[lane], lanes, lane_parameters, lane);
            if (places[lane].stop < 0)
                busy--;
            else
                start_cycle_of_stop(&work, &places[lane], state_in(lanes, lane));
        }
    }
    free(lanes);
    free(lane_parameters);
}
