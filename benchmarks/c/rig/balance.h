#ifndef BALANCE_H
#define BALANCE_H

#include "../physics/vehicle.h"
#include "records.h"

/* Position, height or pitch half a step ago. */
static inline double behind(double position, double speed, const Parameters *p)
{
    return position - 0.5 * p->step * speed;
}

#define FRAME_ENERGY(frame, mass, inertia, p)                                                   \
    (kinetic_energy((mass), (frame)->speed) + kinetic_energy((mass), (frame)->vertical_speed) + \
     kinetic_energy((inertia), (frame)->pitch_rate) +                                           \
     (mass) * (p)->gravity * ((p)->gradient * behind((frame)->position, (frame)->speed, (p))))

#define PLACE(frame, above, p)                                 \
    longitudinal(behind((frame)->position, (frame)->speed, p), \
                 behind((frame)->pitch, (frame)->pitch_rate, p), (above))

#define HEIGHT(frame, ahead, p)                                     \
    vertical(behind((frame)->height, (frame)->vertical_speed, p),   \
             behind((frame)->pitch, (frame)->pitch_rate, p), (ahead))

static inline double joint_shift(const Car *car, const Bogie *bogie, double height, const Parameters *p)
{
    return PLACE(car, height - p->body_height, p) - PLACE(bogie, height - p->bogie_height, p);
}

static inline double secondary_energy(const Car *car, const Bogie *bogie, const Parameters *p)
{
    double rise = HEIGHT(car, bogie->ahead, p) - HEIGHT(bogie, 0.0, p);
    double energy = spring_energy(p->secondary_vertical_stiffness, rise);
    energy += spring_energy(p->secondary_longitudinal_stiffness, joint_shift(car, bogie, p->secondary_height, p));
    return energy + spring_energy(p->link_stiffness, joint_shift(car, bogie, p->link_height, p));
}

static inline double wheelset_energy(const Wheelset *wheelset, const Bogie *bogie, const Parameters *p)
{
    double position = behind(wheelset->position, wheelset->speed, p);
    double shift = position - PLACE(bogie, wheelset->wheel_radius - p->bogie_height, p);
    double rise = HEIGHT(bogie, wheelset->ahead, p);
    double springs = spring_energy(p->primary_longitudinal_stiffness, shift) +
                     spring_energy(p->primary_vertical_stiffness, rise);
    double motion =
        kinetic_energy(p->wheelset_mass, wheelset->speed) + kinetic_energy(wheelset->rotational_inertia, wheelset->rotation);
    return springs + motion + p->wheelset_mass * p->gravity * (p->gradient * position);
}

static inline double stored_energy(const Car *car, const Bogie *bogies, const Wheelset *wheelsets, const Parameters *p)
{
    double energy = FRAME_ENERGY(car, p->body_mass, p->body_inertia, p);
    for (int j = 0; j < 2; j++) {
        energy += FRAME_ENERGY(&bogies[j], p->bogie_mass, p->bogie_inertia, p);
        energy += secondary_energy(car, &bogies[j], p);
    }
    for (int i = 0; i < 4; i++)
        energy += wheelset_energy(&wheelsets[i], &bogies[i / 2], p);
    return energy;
}

static inline double rail_work(const Wheelset *wheelset, const Parameters *p)
{
    double turned = kinetic_energy(wheelset->rotational_inertia, wheelset->rotation);
    double turned_first = kinetic_energy(wheelset->rotational_inertia, p->initial_speed / wheelset->wheel_radius);
    double braked = wheelset->brake_heat + wheelset->dynamic_energy;
    return braked + wheelset->contact_loss + (turned - turned_first);
}

static inline double energy_residual(const Car *car, const Bogie *bogies, const Wheelset *wheelsets,
                                     const Parameters *p)
{
    double lost = car->damper_loss + car->resistance_loss;
    for (int i = 0; i < 4; i++) {
        lost += wheelsets[i].brake_heat + wheelsets[i].contact_loss;
        lost += wheelsets[i].dynamic_energy;
    }
    return (stored_energy(car, bogies, wheelsets, p) + lost - car->initial_energy) / car->initial_energy;
}

static inline double stored_air(const Car *car, const Wheelset *wheelsets)
{
    double air = car->reservoir_mass + car->line_mass;
    for (int i = 0; i < 4; i++)
        air += wheelsets[i].air_mass;
    return air;
}

static inline double air_residual(const Car *car, const Wheelset *wheelsets)
{
    double released = car->exhausted_air;
    for (int i = 0; i < 4; i++)
        released += wheelsets[i].vented_air;
    double balance = stored_air(car, wheelsets) + released - car->compressor_air - car->initial_air;
    return balance / car->consumed_air;
}

static inline double stored_air_energy(const Car *car, const Wheelset *wheelsets, const Parameters *p)
{
    double energy = car->line_mass * car->line_temperature;
    for (int i = 0; i < 4; i++)
        energy += wheelsets[i].air_mass * wheelsets[i].air_temperature;
    return energy * p->heat_capacity_volume;
}

static inline double air_energy_residual(const Car *car, const Wheelset *wheelsets, const Parameters *p)
{
    double gained = car->supplied_enthalpy - car->exhausted_enthalpy + car->line_heat;
    for (int i = 0; i < 4; i++)
        gained += wheelsets[i].wall_heat - wheelsets[i].vented_enthalpy - wheelsets[i].piston_work;
    return (stored_air_energy(car, wheelsets, p) - car->initial_air_energy - gained) / car->supplied_enthalpy;
}

#endif
