#ifndef RUNNING_GEAR_H
#define RUNNING_GEAR_H

#include "../physics/clamping_force.h"
#include "../physics/vehicle.h"
#include "slip_search.h"

#define LOWEST_LOAD 0.2

/* A force, a moment and the motions they advance stand in the same fields of a car body and of a bogie. */
#define CLEAR_FORCES(frame)                       \
    do {                                          \
        (frame)->longitudinal_force = number(0.0); \
        (frame)->vertical_force = number(0.0);    \
        (frame)->moment = number(0.0);            \
    } while (0)

#define STEP_FRAME(frame, mass, mass_response, pitch_response, resistance, p)            \
    do {                                                                                 \
        real drag_ = (resistance) + gradient_force((mass), (p)->gradient, (p)->gravity); \
        (frame)->speed += (mass_response) * ((frame)->longitudinal_force - drag_);       \
        (frame)->vertical_speed += (mass_response) * (frame)->vertical_force;            \
        (frame)->pitch_change = (pitch_response) * (frame)->moment;                      \
        (frame)->pitch_rate += (frame)->pitch_change;                                    \
        (frame)->position += (p)->step * (frame)->speed;                                 \
        (frame)->height += (p)->step * (frame)->vertical_speed;                          \
        (frame)->pitch += (p)->step * (frame)->pitch_rate;                               \
    } while (0)

OURS void couple_longitudinally(Car *car, Bogie *bogie, real stiffness, real damping, real height, const Parameters *p)
{
    real above_body = height - p->body_height;
    real above_bogie = height - p->bogie_height;
    real shift =
        longitudinal(car->position, car->pitch, above_body) - longitudinal(bogie->position, bogie->pitch, above_bogie);
    real rate = longitudinal(car->speed, car->pitch_rate, above_body) -
                longitudinal(bogie->speed, bogie->pitch_rate, above_bogie);
    real pull = suspension_force(stiffness, damping, shift, rate);
    bogie->longitudinal_force += pull;
    bogie->moment -= above_bogie * pull;
    car->longitudinal_force -= pull;
    car->moment += above_body * pull;
    car->damper_loss += p->step * damping * rate * rate;
}

OURS void couple_body(Car *car, Bogie *bogie, const Parameters *p)
{
    couple_longitudinally(car, bogie, p->secondary_longitudinal_stiffness, p->secondary_longitudinal_damping,
                          p->secondary_height, p);
    couple_longitudinally(car, bogie, p->link_stiffness, p->link_damping, p->link_height, p);
    real rise = vertical(car->height, car->pitch, bogie->ahead) - bogie->height;
    real rate = vertical(car->vertical_speed, car->pitch_rate, bogie->ahead) - bogie->vertical_speed;
    real lift = suspension_force(p->secondary_vertical_stiffness, p->secondary_vertical_damping, rise, rate);
    bogie->vertical_force += lift;
    car->vertical_force -= lift;
    car->moment -= bogie->ahead * lift;
    car->damper_loss += p->step * p->secondary_vertical_damping * rate * rate;
}

/* Returns the thrust of suspension and gradient on the wheelset. */
OURS real couple_wheelset(Wheelset *wheelset, Bogie *bogie, Car *car, const Parameters *p)
{
    real above = wheelset->wheel_radius - p->bogie_height;
    real shift = wheelset->position - longitudinal(bogie->position, bogie->pitch, above);
    real rate = wheelset->speed - longitudinal(bogie->speed, bogie->pitch_rate, above);
    real pull = suspension_force(p->primary_longitudinal_stiffness, p->primary_longitudinal_damping, shift, rate);
    real rise = vertical(bogie->height, bogie->pitch, wheelset->ahead);
    real rise_rate = vertical(bogie->vertical_speed, bogie->pitch_rate, wheelset->ahead);
    real lift = suspension_force(p->primary_vertical_stiffness, p->primary_vertical_damping, rise, rise_rate);
    bogie->longitudinal_force += pull;
    bogie->vertical_force -= lift;
    bogie->moment -= fma(above, pull, wheelset->ahead * lift);
    car->damper_loss += p->step * fma(p->primary_longitudinal_damping * rate, rate,
                                      p->primary_vertical_damping * rise_rate * rise_rate);
    wheelset->wheel_load = maximum(fma(-0.5, lift, p->static_wheel_load), LOWEST_LOAD * p->reference_load);
    real friction_torque =
        wheelset->brake_force * brake_torque(wheelset->clamping_force, p->calipers_per_wheelset, p->pads_per_caliper,
                                             wheelset->pad_friction, p->disc_radius);
    wheelset->torque = friction_torque + wheelset->dynamic_torque;
    return -pull - gradient_force(p->wheelset_mass, p->gradient, p->gravity);
}

/* What the brakes of a wheelset do in a step: both torques, and the mean rotation of the discs. */
typedef struct {
    real friction, dynamic, rotation;
} Braking;

OURS Braking step_wheelset(Wheelset *wheelset, Bogie *bogie, real thrust, real sliding_force, const Slip *slip,
                           const Parameters *p)
{
    real speed = wheelset->speed;
    real rotation = wheelset->rotation;
    real direction = turning_direction(rotation, speed);
    real slip_change = slip->free - slip->estimate;
    real turning_creep = slip->direction * slip_change * wheelset->slip_stiffness;
    real moment = fma(wheelset->wheel_radius, turning_creep, -direction * wheelset->torque);
    real turned = fma(wheelset->inertia_response, moment, rotation);
    mask locked = turned * direction <= 0.0;
    real free_speed = fma(p->mass_response, thrust, speed);
    real sliding_creep = locked_force(speed, free_speed, sliding_force, p->mass_response);
    real holding = fma(wheelset->wheel_radius, sliding_creep, rotation * wheelset->inertia_stiffness);
    real creep = choose(locked, sliding_creep, turning_creep);
    real braking = choose(locked, holding, direction * wheelset->torque);
    wheelset->creep_force = creep;
    wheelset->speed = fma(-p->mass_response, creep, free_speed);
    wheelset->rotation = choose(locked, number(0.0), turned);
    wheelset->position += p->step * wheelset->speed;
    real turning = 0.5 * (rotation + wheelset->rotation);
    wheelset->angle += p->step * turning;
    wheelset->contact_loss += p->step * creep * (0.5 * (speed + wheelset->speed) - wheelset->wheel_radius * turning);
    bogie->moment -= braking;
    real dynamic = direction * wheelset->dynamic_torque;
    return (Braking){braking - dynamic, dynamic, turning + bogie->pitch_rate};
}

OURS void account_for_brakes(Wheelset *wheelset, const Bogie *bogie, Braking braking, const Parameters *p)
{
    real rubbing = fma(number(0.5), bogie->pitch_change, braking.rotation);
    wheelset->brake_heat += p->step * braking.friction * rubbing;
    wheelset->dynamic_energy += p->step * braking.dynamic * rubbing;
}

OURS void step_body(Car *car, const Parameters *p)
{
    real speed = car->speed;
    real position = car->position;
    real drag = running_resistance(speed, p->resistance_constant, p->resistance_linear, p->resistance_quadratic);
    STEP_FRAME(car, p->body_mass, p->body_mass_response, p->body_pitch_response, drag, p);
    car->resistance_loss += p->step * drag * 0.5 * (speed + car->speed);
    mask stops = (1.0 - car->stopped) * choose(car->speed <= 0.0, number(1.0), number(0.0)) > 0.0;
    real share = speed / choose(stops, speed - car->speed, number(1.0));
    car->stop_time = choose(stops, car->time + share * p->step, car->stop_time);
    car->stop_position = choose(stops, position + 0.5 * share * p->step * speed, car->stop_position);
    car->stopped = choose(stops, number(1.0), car->stopped);
}

#endif
