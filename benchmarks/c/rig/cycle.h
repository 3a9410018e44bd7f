/* Once per controller cycle: sensors are read, the controller decides, the valves are told. */
#ifndef CYCLE_H
#define CYCLE_H

#include "../controllers/threshold.h"
#include "../physics/once_per_cycle.h"
#include "records.h"

enum { SPEED = 0, PRESSURE = 1, LOADCELL = 2, CHANNELS = 16, LINE = 4 * CHANNELS };

/* Friction laws: places, friction coefficients there, times, factors then; `width` numbers each. */
typedef struct {
    const double *rows;
    int64_t width;
} Rail;

static inline double noise(const Parameters *p, int64_t cycle, int channel)
{
    uint32_t word_0 = (uint32_t)cycle, word_1 = (uint32_t)channel;
    threefry((uint32_t)p->seed, (uint32_t)p->noise_key, &word_0, &word_1);
    return bell(word_0, word_1);
}

static inline void read_module_sensors(Wheelset *wheelset, const Parameters *p, int64_t cycle, int place)
{
    int channel = place * CHANNELS;
    wheelset->pressure_error = wheelset->pressure_noise * noise(p, cycle, channel + PRESSURE);
    wheelset->loadcell_error = wheelset->loadcell_noise * noise(p, cycle, channel + LOADCELL);
    wheelset->measured_speed =
        speed_reading(wheelset->rotation * wheelset->configured_radius, wheelset->tooth_pitch,
                      wheelset->timer_resolution, p->cycle_time, wheelset->slowest_measured_speed,
                      wheelset->speed_noise * noise(p, cycle, channel + SPEED) + wheelset->speed_gain_error);
}

static inline void command_valve(Wheelset *wheelset, const Parameters *p)
{
    if (p->wsp_active == 0)
        wheelset->valve_command = FILL;
    wheelset->command_register = remember(wheelset->command_register, wheelset->valve_command);
    int64_t before = command_before(wheelset->command_register, wheelset->valve_delay_cycles + 1);
    int64_t after = command_before(wheelset->command_register, wheelset->valve_delay_cycles);
    wheelset->fill_before = before == FILL;
    wheelset->fill_after = after == FILL;
    wheelset->vent_before = before == VENT;
    wheelset->vent_after = after == VENT;
    wheelset->venting = wheelset->valve_command == VENT;
    wheelset->filling_cycles = wheelset->valve_command == FILL ? wheelset->filling_cycles + 1 : 0;
    wheelset->wsp_acting = wheelset->filling_cycles < p->wsp_acting_cycles;
}

static inline void read_sensors(Car *car, Wheelset *wheelsets, const Parameters *p)
{
    for (int i = 0; i < 4; i++)
        read_module_sensors(&wheelsets[i], p, car->cycle, i);
    car->line_pressure_error = p->line_sensor_noise * noise(p, car->cycle, LINE);
}

static inline void start_cycle(Car *car, Wheelset *wheelsets, const Parameters *p, Rail rail)
{
    const double *places = rail.rows, *frictions = places + rail.width;
    const double *times = frictions + rail.width, *factors = times + rail.width;
    double factor = interpolated(car->time, times, factors, p->friction_times);
    for (int i = 0; i < 4; i++) {
        double along = interpolated(car->position - wheelsets[i].behind, places, frictions, p->friction_points);
        wheelsets[i].friction = along * factor;
    }
    decide_by_threshold(car, wheelsets, p);
    for (int i = 0; i < 4; i++)
        command_valve(&wheelsets[i], p);
    car->substep = 0.0;
    car->cycle++;
}

#endif
