/* Noise, speed sensor, friction laws and the valve's memory: used once per controller cycle, by one stop at a time. */
#ifndef ONCE_PER_CYCLE_H
#define ONCE_PER_CYCLE_H

#include <math.h>
#include <stdint.h>

enum { FILL = 0, HOLD = 1, VENT = 2 };
#define LONGEST_DELAY_CYCLES 24

static inline uint32_t rotated(uint32_t x, int rotation) { return (x << rotation) | (x >> (32 - rotation)); }

static inline void four_rounds(uint32_t *x, uint32_t *y, const int rotations[4])
{
    for (int i = 0; i < 4; i++) {
        *x += *y;
        *y = *x ^ rotated(*y, rotations[i]);
    }
}

/* Threefry-2x32, 20 rounds. */
static inline void threefry(uint32_t key_0, uint32_t key_1, uint32_t *x, uint32_t *y)
{
    static const int even[4] = {13, 15, 26, 6}, odd[4] = {17, 29, 16, 24};
    const uint32_t keys[3] = {key_0, key_1, 0x1BD11BDAu ^ key_0 ^ key_1};
    *x += keys[0];
    *y += keys[1];
    for (uint32_t block = 0; block < 5; block++) {
        four_rounds(x, y, block % 2 ? odd : even);
        *x += keys[(block + 1) % 3];
        *y += keys[(block + 2) % 3] + block + 1;
    }
}

static inline double bell(uint32_t word_0, uint32_t word_1)
{
    int64_t total = (int64_t)(word_0 & 0xFFFF) + (word_0 >> 16) + (word_1 & 0xFFFF) + (word_1 >> 16);
    return (((double)total + 2.0) * (1.0 / 65536.0) - 2.0) * 1.7320508075688772;
}

static inline double speed_reading(double circumferential_speed, double tooth_pitch, double timer_resolution,
                                   double cycle_time, double slowest, double noise)
{
    double measurable = circumferential_speed > slowest ? circumferential_speed : slowest;
    double teeth = fmax(floor(measurable * cycle_time / tooth_pitch), 1.0);
    double distance = teeth * tooth_pitch;
    double ticks = fmax(floor(distance / measurable / timer_resolution + 0.5), 1.0);
    double reading = distance / (ticks * timer_resolution) * (1.0 + noise);
    return circumferential_speed < slowest ? 0.0 : reading;
}

static inline double interpolated(double at, const double *places, const double *values, int64_t count)
{
    int64_t i = 0;
    if (at < places[0])
        return values[0];
    while (i + 1 < count && places[i + 1] <= at)
        i++;
    if (i + 1 >= count)
        return values[count - 1];
    double share = (at - places[i]) / (places[i + 1] - places[i]);
    return values[i] + share * (values[i + 1] - values[i]);
}

static inline int64_t remember(int64_t past, int64_t command)
{
    return ((past << 2) | command) & ((INT64_C(1) << (2 * (LONGEST_DELAY_CYCLES + 2))) - 1);
}

static inline int64_t command_before(int64_t past, int64_t cycles) { return (past >> (2 * cycles)) & 3; }

#endif
