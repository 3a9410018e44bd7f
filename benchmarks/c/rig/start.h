#ifndef START_H
#define START_H

#include "../controllers/threshold.h"
#include "balance.h"
#include "records.h"

static inline void start_supply(Car *car, const Parameters *p)
{
    car->reservoir_pressure = p->reservoir_pressure;
    car->line_pressure = p->atmospheric_pressure;
    car->line_temperature = p->air_temperature;
    car->line_coldness = p->air_coldness;
    car->reservoir_mass = p->reservoir_pressure * p->reservoir_volume / (p->gas_constant * p->air_temperature);
    car->line_mass = p->atmospheric_pressure * p->line_volume / (p->gas_constant * p->air_temperature);
}

static inline void start_wheelset(Wheelset *wheelset, const Parameters *p)
{
    wheelset->speed = p->initial_speed;
    wheelset->rotation = p->initial_speed / wheelset->wheel_radius;
    wheelset->wheel_load = p->static_wheel_load;
    wheelset->speed_valid = 1;
    wheelset->held_speed = p->initial_speed;
    wheelset->pad_friction = wheelset->reference_pad_friction;
    wheelset->friction_ratio = p->friction_ratio;
    wheelset->friction_decay = p->friction_decay;
    wheelset->reduction_adhesion = p->reduction_adhesion;
    wheelset->reduction_slip = p->reduction_slip;
    wheelset->disc_temperature = p->initial_disc_temperature;
    wheelset->disc_surface_temperature = p->initial_disc_temperature;
}

static inline void start_module(Wheelset *wheelset, double has_caliper, const Parameters *p)
{
    double volume = has_caliper > 0.0 ? p->caliper_tank_volume : p->tank_volume;
    wheelset->has_caliper = has_caliper;
    wheelset->filling_cycles = 1000000;
    wheelset->fill_opening = 1.0;
    wheelset->pressure = p->atmospheric_pressure;
    wheelset->air_temperature = p->air_temperature;
    wheelset->air_coldness = p->air_coldness;
    wheelset->air_mass = p->atmospheric_pressure * volume / (p->gas_constant * p->air_temperature);
    wheelset->modelled_tank_pressure = p->atmospheric_pressure;
    wheelset->modelled_tank_air = p->atmospheric_pressure;
    wheelset->modelled_pressure = p->atmospheric_pressure;
    wheelset->modelled_volume = 1.0 - p->modelled_swept_share;
    wheelset->modelled_air = p->atmospheric_pressure * wheelset->modelled_volume;
    wheelset->pressure_ratio = 1.0;
}

static inline void start(Car *car, Bogie *bogies, Wheelset *wheelsets, const Parameters *p,
                         const WheelsetParameters *wheelset_parameters)
{
    car->speed = p->initial_speed;
    start_supply(car, p);
    car->demand_change = p->commanded_pressure;
    car->demand_begins = p->dead_time;
    car->demand_rate = p->filling_rate;
    car->brake_command = p->commanded_pressure * p->demand_per_pressure;
    car->axle_load = 2.0 * p->static_wheel_load;
    for (int j = 0; j < 2; j++) {
        bogies[j].speed = p->initial_speed;
        bogies[j].ahead = p->half_pivot_distance * (1.0 - 2.0 * j);
    }
    for (int i = 0; i < 4; i++) {
        double side = 1.0 - 2.0 * (i % 2);
        copy_wheelset_parameters(&wheelsets[i], &wheelset_parameters[i]);
        start_wheelset(&wheelsets[i], p);
        start_module(&wheelsets[i], i < p->calipers ? 1.0 : 0.0, p);
        wheelsets[i].ahead = side * p->half_wheelbase;
        wheelsets[i].behind = p->half_pivot_distance - bogies[i / 2].ahead + p->half_wheelbase * (1.0 - side);
    }
    begin_threshold(car, wheelsets, p->initial_speed);
    car->initial_energy = stored_energy(car, bogies, wheelsets, p);
    car->initial_air = stored_air(car, wheelsets);
    car->initial_air_energy = stored_air_energy(car, wheelsets, p);
}

#endif
