/* The rig of uictest.rig.stop in C: one stop on zeroed records, from the brake command to standstill.
 *
 * The same operations in the same order, so that without contraction both give the same bits. The records' layout comes from
 * records.h, which the benchmark generates from the dtypes of uictest.
 */
#include "rig/cycle.h"
#include "rig/observation.h"
#include "rig/start.h"
#include "rig/step.h"

void stop(Car *restrict car, Bogie *restrict bogies, Wheelset *restrict wheelsets, const Parameters *restrict p,
          const WheelsetParameters *restrict wheelset_parameters, const double *rail, int64_t rail_width, Measures *restrict measures,
          WheelsetMeasures *restrict wheelset_measures)
{
    Rail laws = {rail, rail_width};
    start(car, bogies, wheelsets, p, wheelset_parameters);
    begin_stop_measures(car, measures, wheelset_measures, p);
    while (car->stopped == 0.0 && car->cycle < p->cycles) {
        read_sensors(car, wheelsets, p);
        start_cycle(car, wheelsets, p, laws);
        for (int64_t k = 0; k < p->steps_per_cycle; k++)
            step(car, bogies, wheelsets, p);
        observe_cycle(car, wheelsets, measures, wheelset_measures, p);
    }
    close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p);
}
