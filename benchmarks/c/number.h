/* What a number is: one double, or the same number of LANES stops side by side.
 *
 * Physics and the base step are written once in terms of `real`, as they are in Python. With lanes the file is compiled as
 * C++, whose vectors know the conditional operator; the rest of the language used here is C.
 */
#ifndef NUMBER_H
#define NUMBER_H

#include <math.h>
#include <stdint.h>

#ifdef LANES
typedef double real __attribute__((vector_size(8 * LANES)));
typedef int64_t integer __attribute__((vector_size(8 * LANES)));
typedef integer mask;
#else
typedef double real;
typedef int64_t integer;
typedef int mask;
#endif

#define OURS static inline __attribute__((always_inline))

#ifdef LANES
OURS real number(double x) { return x - (real){}; }
OURS real number(real x) { return x; }
#if defined(STRICT) && LANES == 8 && defined(__AVX512F__)
#include <immintrin.h>
OURS real fused(real a, real b, real c) { return (real)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c); }
OURS real sqrt_of(real x) { return (real)_mm512_sqrt_pd((__m512d)x); }
#define fma(a, b, c) fused(number(a), number(b), number(c))
#elif defined(STRICT) && LANES == 4 && defined(__FMA__)
#include <immintrin.h>
OURS real fused(real a, real b, real c) { return (real)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c); }
OURS real sqrt_of(real x) { return (real)_mm256_sqrt_pd((__m256d)x); }
#define fma(a, b, c) fused(number(a), number(b), number(c))
#else
#define fma(a, b, c) ((a) * (b) + (c)) /* which the compiler may contract */
OURS real sqrt_of(real x)
{
    real y;
    for (int k = 0; k < LANES; k++)
        y[k] = sqrt(x[k]);
    return y;
}
#endif
OURS real size_of(real x) { return x < 0.0 ? -x : x; }
#else
OURS real number(double x) { return x; }
OURS real sqrt_of(real x) { return sqrt(x); }
OURS real size_of(real x) { return fabs(x); }
#endif

#endif
