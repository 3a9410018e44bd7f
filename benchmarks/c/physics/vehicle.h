/* Points of rigid bodies, suspensions, running resistance. */
#ifndef VEHICLE_H
#define VEHICLE_H

#include "arithmetic.h"

OURS real longitudinal(real position, real pitch, real height) { return fma(-height, pitch, position); }
OURS real vertical(real position, real pitch, real ahead) { return fma(ahead, pitch, position); }

OURS real suspension_force(real stiffness, real damping, real deflection, real rate)
{
    return fma(stiffness, deflection, damping * rate);
}

OURS real spring_energy(real stiffness, real deflection) { return 0.5 * stiffness * deflection * deflection; }
OURS real kinetic_energy(real inertia, real speed) { return 0.5 * inertia * speed * speed; }

OURS real running_resistance(real speed, real constant, real linear, real quadratic)
{
    real size = size_of(speed);
    real direction = choose(speed > 0.0, number(1.0), choose(speed < 0.0, number(-1.0), number(0.0)));
    return direction * fma(fma(quadratic, size, linear), size, constant);
}

OURS real gradient_force(real mass, real gradient, real gravity) { return mass * gravity * gradient; }

#endif
