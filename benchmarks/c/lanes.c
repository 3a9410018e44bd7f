/* Many stops in WIDTH lanes: a lane whose stop has ended takes the next one.
 *
 * Sensors, controllers and measures are scalar: once per controller cycle the state of each lane is copied out and back.
 * All stops have the same base step and controller cycle.
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
typedef double Lanes[WIDTH];

void steps_in_lanes(Lanes *car, Lanes *bogies, Lanes *wheelsets, const Lanes *p, int64_t steps);

static void put(Lanes *lanes, int lane, const void *record, size_t numbers)
{
    for (size_t i = 0; i < numbers; i++)
        memcpy(&lanes[i][lane], (const char *)record + i * sizeof(double), sizeof(double));
}

static void get(void *record, Lanes *lanes, int lane, size_t numbers)
{
    for (size_t i = 0; i < numbers; i++)
        memcpy((char *)record + i * sizeof(double), &lanes[i][lane], sizeof(double));
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

static void take_next(Work *work, Place *place, State *state, Lanes *parameters, int lane)
{
    place->stop = work->next < work->count ? work->next++ : -1;
    if (place->stop < 0)
        return;
    const Parameters *p = &work->parameters[place->stop];
    memset(state, 0, sizeof *state);
    start(&state->car, state->bogies, state->wheelsets, p, &work->wheelset_parameters[4 * place->stop]);
    begin_stop_measures(&state->car, &work->measures[place->stop], &work->wheelset_measures[4 * place->stop], p);
    put(parameters, lane, p, NUMBERS(Parameters));
}

/* Close a cycle of one lane; refill the lane when its stop has ended. */
static void end_cycle(Work *work, Place *place, State *state, Lanes *parameters, int lane)
{
    const Parameters *p = &work->parameters[place->stop];
    Measures *measures = &work->measures[place->stop];
    WheelsetMeasures *wheelset_measures = &work->wheelset_measures[4 * place->stop];
    observe_cycle(&state->car, state->wheelsets, measures, wheelset_measures, p);
    if (state->car.stopped == 0.0 && state->car.cycle < p->cycles)
        return;
    close_stop_measures(&state->car, state->bogies, state->wheelsets, measures, wheelset_measures, p);
    take_next(work, place, state, parameters, lane);
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
    Lanes *lanes = aligned_alloc(64, NUMBERS(State) * sizeof(Lanes));
    Lanes *lane_parameters = aligned_alloc(64, NUMBERS(Parameters) * sizeof(Lanes));
    Lanes *car = lanes, *bogies = car + NUMBERS(Car), *wheelsets = bogies + 2 * NUMBERS(Bogie);
    Place places[WIDTH];
    State state;
    int64_t steps = parameters[0].steps_per_cycle, busy = 0;
    for (int lane = 0; lane < WIDTH; lane++) {
        take_next(&work, &places[lane], &state, lane_parameters, lane);
        if (places[lane].stop < 0) { /* fewer stops than lanes: an idle lane repeats the last stop unseen */
            put(lane_parameters, lane, &parameters[count - 1], NUMBERS(Parameters));
        } else {
            start_cycle_of_stop(&work, &places[lane], &state);
            busy++;
        }
        put(lanes, lane, &state, NUMBERS(State));
    }
    while (busy > 0) {
        steps_in_lanes(car, bogies, wheelsets, lane_parameters, steps);
        for (int lane = 0; lane < WIDTH; lane++) {
            if (places[lane].stop < 0)
                continue;
            get(&state, lanes, lane, NUMBERS(State));
            end_cycle(&work, &places[lane], &state, lane_parameters, lane);
            if (places[lane].stop < 0) {
                busy--;
                continue;
            }
            start_cycle_of_stop(&work, &places[lane], &state);
            put(lanes, lane, &state, NUMBERS(State));
        }
    }
    free(lanes);
    free(lane_parameters);
}
