#ifndef PNEUMATICS_H
#define PNEUMATICS_H

#include "../physics/air.h"
#include "records.h"

OURS real orifice(real pressure_1, real pressure_2, real coldness_1, real coldness_2, real conductance,
                  const Parameters *p)
{
    return mass_flow(pressure_1, pressure_2, coldness_1, coldness_2, conductance, p->critical_ratio, p->subsonic_scale,
                     p->laminar_slope);
}

OURS void move_valve(Wheelset *wheelset, const Car *car)
{
    mask switched = car->substep >= wheelset->valve_delay_steps;
    real fill_target = choose(switched, wheelset->fill_after, wheelset->fill_before);
    real vent_target = choose(switched, wheelset->vent_after, wheelset->vent_before);
    wheelset->fill_opening = travel(wheelset->fill_opening, fill_target, wheelset->valve_travel_per_step);
    wheelset->vent_opening = travel(wheelset->vent_opening, vent_target, wheelset->valve_travel_per_step);
}

/* Air that a vessel gains and loses in a step. */
typedef struct {
    real gained, lost;
} Flows;

OURS Flows step_valve(Wheelset *wheelset, const Car *car, const Parameters *p)
{
    move_valve(wheelset, car);
    Flows flows;
    flows.gained = p->step * orifice(car->line_pressure, wheelset->pressure, car->line_coldness, wheelset->air_coldness,
                                     wheelset->fill_conductance * wheelset->fill_opening, p);
    flows.lost = p->step * orifice(wheelset->pressure, p->atmospheric_pressure, wheelset->air_coldness, p->air_coldness,
                                   wheelset->vent_conductance * wheelset->vent_opening, p);
    return flows;
}

OURS Flows through_relay_valve(const Car *car, const Parameters *p)
{
    real gauge = car->line_pressure - p->atmospheric_pressure;
    real opening = relay_opening(car->demanded_pressure, gauge, p->relay_gain);
    Flows flows;
    flows.gained = p->step * orifice(car->reservoir_pressure, car->line_pressure, p->air_coldness, car->line_coldness,
                                     p->relay_conductance * maximum(opening, number(0.0)), p);
    flows.lost = p->step * orifice(car->line_pressure, p->atmospheric_pressure, car->line_coldness, p->air_coldness,
                                   p->relay_conductance * maximum(-opening, number(0.0)), p);
    return flows;
}

/* Returns the enthalpy of the air that the tank gained. */
OURS real fill_tank(Wheelset *wheelset, Flows flows, const Car *car, const Parameters *p)
{
    real drawn_enthalpy =
        enthalpy(flows.gained, car->line_temperature, wheelset->air_temperature, p->heat_capacity_pressure);
    real vented_enthalpy =
        enthalpy(flows.lost, wheelset->air_temperature, p->air_temperature, p->heat_capacity_pressure);
    mask has_caliper = wheelset->has_caliper > 0.0;
    real swept = wheelset->has_caliper * p->piston_area;
    real volume = fma(swept, wheelset->stroke, choose(has_caliper, p->caliper_tank_volume, p->tank_volume));
    real exchange = choose(has_caliper, p->caliper_tank_exchange, p->tank_exchange);
    real growth = swept * wheelset->stroke_change;
    real gained = flows.gained - flows.lost;
    wheelset->air_mass += gained;
    real rise;
    real warming =
        air_changes(wheelset->pressure, wheelset->air_temperature, wheelset->air_mass, gained,
                drawn_enthalpy - vented_enthalpy, volume, growth, p->air_temperature, exchange, p->gas_constant,
                p->heat_capacity_volume, &rise);
    wheelset->piston_work += wheelset->pressure * growth;
    wheelset->air_temperature += warming;
    wheelset->pressure += rise;
    wheelset->air_coldness = coldness(wheelset->air_temperature);
    wheelset->vented_air += flows.lost;
    wheelset->vented_enthalpy += vented_enthalpy;
    wheelset->wall_heat += exchange * (p->air_temperature - wheelset->air_temperature);
    return drawn_enthalpy;
}

OURS void step_reservoir(Car *car, real filled, const Parameters *p)
{
    car->compressor_running = compressor_running(car->reservoir_pressure, car->compressor_running,
                                                 p->compressor_cut_in, p->compressor_cut_out);
    real delivered = p->step * p->compressor_delivery * car->compressor_running;
    car->reservoir_mass += delivered - filled;
    car->reservoir_pressure = isothermal_pressure(car->reservoir_mass, p->reservoir_stiffness);
    car->compressor_air += delivered;
}

OURS void fill_line(Car *car, Flows flows, real drawn, real drawn_enthalpy, const Parameters *p)
{
    real supplied = enthalpy(flows.gained, p->air_temperature, car->line_temperature, p->heat_capacity_pressure);
    real released = enthalpy(flows.lost, car->line_temperature, p->air_temperature, p->heat_capacity_pressure);
    real gained = flows.gained - flows.lost - drawn;
    car->line_mass += gained;
    real rise;
    real warming = air_changes(car->line_pressure, car->line_temperature, car->line_mass, gained,
                           supplied - released - drawn_enthalpy, p->line_volume, number(0.0), p->air_temperature,
                           p->line_exchange, p->gas_constant, p->heat_capacity_volume, &rise);
    car->line_temperature += warming;
    car->line_pressure += rise;
    car->line_coldness = coldness(car->line_temperature);
    car->consumed_air += flows.gained;
    car->exhausted_air += flows.lost;
    car->supplied_enthalpy += supplied;
    car->exhausted_enthalpy += released;
    car->line_heat += p->line_exchange * (p->air_temperature - car->line_temperature);
}

OURS void step_air(Car *car, Wheelset *wheelsets, const Parameters *p)
{
    car->command_pressure = demanded_pressure(car->time, p->commanded_pressure, p->dead_time, p->filling_rate);
    car->demanded_pressure = friction_pressure(car->command_pressure, car->blended_share, p->zero_force_pressure);
    Flows flows[4];
    for (int i = 0; i < 4; i++)
        flows[i] = step_valve(&wheelsets[i], car, p);
    Flows relay = through_relay_valve(car, p);
    real drawn = flows[0].gained;
    real drawn_enthalpy = fill_tank(&wheelsets[0], flows[0], car, p);
    for (int i = 1; i < 4; i++) {
        drawn += flows[i].gained;
        drawn_enthalpy += fill_tank(&wheelsets[i], flows[i], car, p);
    }
    step_reservoir(car, relay.gained, p);
    fill_line(car, relay, drawn, drawn_enthalpy, p);
}

#endif
