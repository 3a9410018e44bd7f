#ifndef ARITHMETIC_H
#define ARITHMETIC_H

#include "../number.h"

OURS real choose(mask condition, real when_true, real when_false) { return condition ? when_true : when_false; }
OURS real minimum(real a, real b) { return a < b ? a : b; }
OURS real maximum(real a, real b) { return a > b ? a : b; }
OURS real clamp(real x, real low, real high) { return minimum(maximum(x, low), high); }

OURS real exponential(real x)
{
    real t = maximum(x, number(-40.0)) * (1.0 / 256.0);
    real t2 = t * t;
    real t4 = t2 * t2;
    real low = (1.0 + t) + t2 * (0.5 + t * (1.0 / 6.0));
    real middle = (1.0 / 24.0 + t * (1.0 / 120.0)) + t2 * (1.0 / 720.0 + t * (1.0 / 5040.0));
    real high = (1.0 / 40320.0 + t * (1.0 / 362880.0)) + t2 * (1.0 / 3628800.0);
    real p = low + t4 * (middle + t4 * high);
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    p = p * p;
    return p * p;
}

/* Cephes Mathematical Library, atan.c. */
OURS real arctan(real x)
{
    const double p0 = -8.750608600031904122785e-1, p1 = -1.615753718733365076637e1, p2 = -7.500855792314704667340e1,
                 p3 = -1.228866684490136173410e2, p4 = -6.485021904942025371773e1;
    const double q0 = 2.485846490142306297962e1, q1 = 1.650270098316988542046e2, q2 = 4.328810604912902668951e2,
                 q3 = 4.853903996359136964868e2, q4 = 1.945506571482613964425e2;
    mask large = x > 2.414213562373095;
    mask middle = x > 0.66;
    real numerator = choose(large, number(-1.0), choose(middle, x - 1.0, x));
    real denominator = choose(large, x, choose(middle, x + 1.0, number(1.0)));
    real base =
        choose(large, number(1.5707963267948966), choose(middle, number(0.7853981633974483), number(0.0)));
    real t = numerator / denominator;
    real z = t * t;
    real z2 = z * z;
    real p = (p4 + p3 * z) + z2 * ((p2 + p1 * z) + p0 * z2);
    real q = (q4 + q3 * z) + z2 * ((q2 + q1 * z) + z2 * (q0 + z));
    return base + (t * (z * p / q) + t);
}

/* x^(2/3) on [0.2, 2.5]: Householder's iteration for x^(-1/3). */
OURS real power_two_thirds(real x)
{
    real y = 1.908649 + x * (-1.571604 + x * (0.793567 + x * -0.141773));
    for (int i = 0; i < 3; i++) {
        real cube = x * y * y * y;
        y = y * (14.0 - cube * (7.0 - 2.0 * cube)) * (1.0 / 9.0);
    }
    return x * y;
}

#endif
