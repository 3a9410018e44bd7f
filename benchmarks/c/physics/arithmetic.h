#ifndef ARITHMETIC_H
#define ARITHMETIC_H

#include "../number.h"

OURS real choose(mask condition, real when_true, real when_false) { return condition ? when_true : when_false; }
OURS real minimum(real a, real b) { return a < b ? a : b; }
OURS real maximum(real a, real b) { return a > b ? a : b; }
OURS real clamp(real x, real low, real high) { return minimum(maximum(x, low), high); }

OURS real exponential(real x)
{
    const double e0 = 1.0, e1 = 0.4999999999999881, e2 = 0.1666666666655385, e3 = 0.0416666666254208,
                 e4 = 0.00833333257720033, e5 = 0.0013888810912275637, e6 = 0.0001983653503433632,
                 e7 = 2.463325359996458e-05, e8 = 2.429319469234341e-06;
    real t = maximum(x, number(-36.0)) * (1.0 / 128.0);
    real t2 = t * t;
    real t4 = t2 * t2;
    real low = fma(t2, fma(e3, t, e2), fma(e1, t, e0));
    real high = fma(t2, fma(e7, t, e6), fma(e5, t, e4));
    real p = fma(t, fma(t4, fma(t4, e8, high), low), 1.0);
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    return p * p;
}

/* Split arctan(y / x) into an angle and a rest of at most pi/8, whose tangent is opposite / adjacent. */
OURS real octant(real y, real x, real *opposite, real *adjacent)
{
    mask steep = y > 2.414213562373095 * x;
    mask middle = y > 0.41421356237309503 * x;
    *opposite = choose(steep, -x, choose(middle, y - x, y));
    *adjacent = choose(steep, y, choose(middle, x + y, x));
    return choose(steep, number(1.5707963267948966), choose(middle, number(0.7853981633974483), number(0.0)));
}

OURS real arctan_within_octant(real t)
{
    const double a0 = -0.3333333333333325, a1 = 0.19999999999898407, a2 = -0.1428571426609655, a3 = 0.11111109636529681,
                 a4 = -0.09090852557023653, a5 = 0.0769105515567278, a6 = -0.0664961366708796, a7 = 0.05736331996459826,
                 a8 = -0.04483334075026139, a9 = 0.022750519644353994;
    real z = t * t;
    real z2 = z * z;
    real z4 = z2 * z2;
    real low = fma(z2, fma(a3, z, a2), fma(a1, z, a0));
    real middle = fma(z2, fma(a7, z, a6), fma(a5, z, a4));
    return fma(t * z, fma(z4, fma(z4, fma(a9, z, a8), middle), low), t);
}

/* x^(2/3) on [0.2, 2.5]: Householder's iteration for x^(-1/3). */
OURS real power_two_thirds(real x)
{
    real x2 = x * x;
    real y = fma(x2, fma(x2, 0.15147739, fma(-0.99271232, x, 2.39251789)), fma(-2.69745314, x, 2.13334891));
    for (int i = 0; i < 2; i++) {
        real cube = (x * y) * (y * y);
        y = y * fma(-cube, fma(-2.0, cube, 7.0), 14.0) * (1.0 / 9.0);
    }
    return x * y;
}

#endif
