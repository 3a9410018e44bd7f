#ifndef CLAMPING_H
#define CLAMPING_H

#include "../physics/clamping_force.h"
#include "records.h"

OURS void step_caliper(Wheelset *wheelset, real gauge, const Parameters *p)
{
    real stroke = stroke_after(wheelset->stroke, gauge, p->piston_area, p->preload, wheelset->coulomb_friction,
                               p->clearance, p->piston_damping, p->contact_damping, wheelset->squeezing_stiffness,
                               wheelset->releasing_stiffness, p->free_compliance, wheelset->squeezing_compliance,
                               wheelset->releasing_compliance);
    wheelset->stroke_change = stroke - wheelset->stroke;
    wheelset->stroke = stroke;
    wheelset->caliper_force = clamping_force(stroke, p->clearance, p->contact_stiffness, p->lever_ratio);
}

OURS void step_cylinder(Wheelset *wheelset, real reading, const Parameters *p)
{
    real filtered = cylinder_output(reading, wheelset->memory_1, p->b0);
    wheelset->memory_1 = cylinder_memory(reading, filtered, p->b1, p->a1, wheelset->memory_2);
    wheelset->memory_2 = cylinder_memory(reading, filtered, p->b2, p->a2, wheelset->memory_3);
    wheelset->memory_3 = cylinder_memory(reading, filtered, p->b3, p->a3, number(0.0));
    real modelled = (1.0 - wheelset->has_caliper) * p->uses_cylinder_dynamics;
    wheelset->compensated_pressure = choose(modelled > 0.0, filtered, reading);
}

OURS void step_hysteresis(Wheelset *wheelset, const Parameters *p)
{
    real pressure = wheelset->compensated_pressure;
    real share = phase_share(wheelset->wsp_share, wheelset->wsp_acting, p->phase_change_per_step);
    real squeezing =
        force_line(pressure, fma(share, p->wsp_squeezing_slope - p->bc_squeezing_slope, p->bc_squeezing_slope),
                   fma(share, p->wsp_squeezing_intercept - p->bc_squeezing_intercept, p->bc_squeezing_intercept));
    real releasing =
        force_line(pressure, fma(share, p->wsp_releasing_slope - p->bc_releasing_slope, p->bc_releasing_slope),
                   fma(share, p->wsp_releasing_intercept - p->bc_releasing_intercept, p->bc_releasing_intercept));
    wheelset->wsp_share = share;
    real hysteretic = force_after(wheelset->computed_force, squeezing, releasing);
    real linear = force_line(pressure, p->linear_slope, p->linear_intercept);
    real modelled = wheelset->has_caliper + p->uses_hysteresis;
    wheelset->computed_force = choose(modelled > 0.0, hysteretic, linear);
}

OURS void step_clamping(Wheelset *wheelset, const Parameters *p)
{
    real gauge = wheelset->pressure - p->atmospheric_pressure;
    step_caliper(wheelset, gauge, p);
    real reading = analogue_reading(gauge, wheelset->pressure_gain_error, wheelset->pressure_offset, wheelset->pressure_error,
                                    p->pressure_range, p->pressure_resolution, p->pressure_steps);
    wheelset->pressure_saturated_steps += beyond_range(gauge, wheelset->pressure_gain_error, wheelset->pressure_offset,
                                                       wheelset->pressure_error, p->pressure_range);
    wheelset->pressure_reading = reading;
    step_cylinder(wheelset, reading, p);
    step_hysteresis(wheelset, p);
    real loadcells = analogue_reading(wheelset->caliper_force, wheelset->loadcell_gain_error, wheelset->loadcell_offset,
                                      wheelset->loadcell_error, p->loadcell_range,
                                      p->loadcell_resolution, p->loadcell_steps);
    wheelset->loadcell_saturated_steps +=
        wheelset->has_caliper * beyond_range(wheelset->caliper_force, wheelset->loadcell_gain_error,
                                             wheelset->loadcell_offset, wheelset->loadcell_error, p->loadcell_range);
    wheelset->clamping_force = choose(wheelset->has_caliper > 0.0, loadcells, wheelset->computed_force);
}

#endif
