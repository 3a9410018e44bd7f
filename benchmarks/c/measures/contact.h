#ifndef CONTACT_MEASURES_H
#define CONTACT_MEASURES_H

#include "../physics/arithmetic.h"
#include "records.h"

static inline void begin_contact(WheelsetMeasures *m)
{
    m->slid_distance = m->contact_energy = m->contact_loss = 0.0;
    m->rail_work = m->exploited_work = m->available_work = 0.0;
    m->adhesion_utilisation = NAN;
}

static inline void begin_utilisation(Measures *m)
{
    m->exploited_work = m->available_work = 0.0;
    m->adhesion_utilisation = m->deceleration_bogie_1 = m->deceleration_bogie_2 = NAN;
}

static inline double highest_creep_force(double speed, double wheel_load, double initial_friction, double stiffness,
                                         const Parameters *p)
{
    double weight = wheel_load * initial_friction;
    double t = minimum(sqrt(p->highest_creep_scale * speed * weight / stiffness), 1.0);
    double t2 = t * t;
    double t4 = t2 * t2;
    double low = fma(t2, fma(p->highest_creep_3, t, p->highest_creep_2), fma(p->highest_creep_1, t, p->highest_creep_0));
    double high = fma(t2, fma(p->highest_creep_7, t, p->highest_creep_6), fma(p->highest_creep_5, t, p->highest_creep_4));
    return weight * fma(t4, high, low);
}

static inline void observe_contact(WheelsetMeasures *m, Measures *train, const Parameters *p, double time, double speed,
                                   double pressure, double line_pressure, double rail_work, double contact_loss,
                                   double highest_force)
{
    int slides = m->sliding > 0.0;
    double before = train->end_speed >= 0.0 ? train->end_speed : speed;
    double run = 0.5 * (before + speed) * (time - train->end_time);
    if (slides) {
        m->slid_distance += run;
        m->contact_energy += contact_loss - m->contact_loss;
    }
    int has_slid = m->first_sliding_time <= time && speed > p->moving_speed;
    if (slides || (has_slid && pressure < p->reduced_share * line_pressure)) {
        double exploited = rail_work - m->rail_work;
        double available = highest_force * run;
        m->exploited_work += exploited;
        m->available_work += available;
        train->exploited_work += exploited;
        train->available_work += available;
    }
    m->rail_work = rail_work;
    m->contact_loss = contact_loss;
}

static inline double share_of(double part, double whole) { return whole > 0.0 ? part / whole : NAN; }

static inline void close_contacts(Measures *m, WheelsetMeasures *wheelsets, double mass)
{
    m->adhesion_utilisation = share_of(m->exploited_work, m->available_work);
    for (int i = 0; i < 4; i++)
        wheelsets[i].adhesion_utilisation = share_of(wheelsets[i].exploited_work, wheelsets[i].available_work);
    double inertia = mass * m->end_distance;
    m->deceleration_bogie_1 = share_of(wheelsets[0].rail_work + wheelsets[1].rail_work, inertia);
    m->deceleration_bogie_2 = share_of(wheelsets[2].rail_work + wheelsets[3].rail_work, inertia);
}

#endif
