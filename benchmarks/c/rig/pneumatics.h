#ifndef PNEUMATICS_H
#define PNEUMATICS_H

#include "../physics/air.h"
#include "records.h"

OURS real orifice(real pressure_1, real pressure_2, real conductance, const Parameters *p)
{
    return mass_flow(pressure_1, pressure_2, conductance, p->flow_density, p->critical_ratio, p->subsonic_scale,
                     p->laminar_slope);
}

/* Air that flows in a step from a source into a vessel, and from there to the atmosphere (returned). */
OURS real through(real source, real vessel, real conductance_in, real conductance_out, const Parameters *p, real *gained)
{
    *gained = p->step * orifice(source, vessel, conductance_in, p);
    return p->step * orifice(vessel, p->atmospheric_pressure, conductance_out, p);
}

OURS void step_supply(Car *car, real drawn, const Parameters *p)
{
    real gauge = car->line_pressure - p->atmospheric_pressure;
    car->demanded_pressure = demanded_pressure(car->time, p->commanded_pressure, p->dead_time, p->filling_rate);
    real opening = relay_opening(car->demanded_pressure, gauge, p->relay_gain);
    real filled;
    real exhausted =
        through(car->reservoir_pressure, car->line_pressure, p->relay_conductance * maximum(opening, number(0.0)),
                p->relay_conductance * maximum(-opening, number(0.0)), p, &filled);
    car->compressor_running = compressor_running(car->reservoir_pressure, car->compressor_running,
                                                 p->compressor_cut_in, p->compressor_cut_out);
    real delivered = p->step * p->compressor_delivery * car->compressor_running;
    car->reservoir_mass += delivered - filled;
    car->reservoir_pressure = isothermal_pressure(car->reservoir_mass, p->reservoir_stiffness);
    real gained = filled - exhausted - drawn;
    car->line_mass += gained;
    car->line_pressure += pressure_change(car->line_pressure, p->line_stiffness, gained, number(0.0), p->air);
    car->compressor_air += delivered;
    car->consumed_air += filled;
    car->exhausted_air += exhausted;
}

OURS real step_tank(Wheelset *wheelset, const Car *car, const Parameters *p)
{
    mask switched = car->substep >= p->valve_delay_steps;
    real fill_target = choose(switched, wheelset->fill_after, wheelset->fill_before);
    real vent_target = choose(switched, wheelset->vent_after, wheelset->vent_before);
    wheelset->fill_opening = travel(wheelset->fill_opening, fill_target, p->valve_travel_per_step);
    wheelset->vent_opening = travel(wheelset->vent_opening, vent_target, p->valve_travel_per_step);
    real drawn;
    real vented = through(car->line_pressure, wheelset->pressure, p->fill_conductance * wheelset->fill_opening,
                          p->vent_conductance * wheelset->vent_opening, p, &drawn);
    real swept = wheelset->has_caliper * p->piston_area;
    real fixed = choose(wheelset->has_caliper > 0.0, p->caliper_tank_volume, p->tank_volume);
    real stiffness = p->polytropic_exponent / fma(swept, wheelset->stroke, fixed);
    real growth = swept * wheelset->stroke_change;
    wheelset->air_mass += drawn - vented;
    wheelset->vented_air += vented;
    wheelset->pressure += pressure_change(wheelset->pressure, stiffness, drawn - vented, growth, p->air);
    return drawn;
}

#endif
