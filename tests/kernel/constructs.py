"""Every construct that the generator takes, in functions of numbers with the same bits in C++."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from uictest.core.physics import HOLD, arithmetic, fma
from uictest.core.physics.arithmetic import clamp, exp, floor, maximum, minimum, octant, select, sqrt

LIMIT = 2.5
COUNT = 3
ENORMOUS = 2**63 - 1
INFINITE = float("inf")
WEIGHTS = (0.5, -0.0, 1e-320, 3)
PLACES = (4, 1, 2, 0)
ON = True


class Pair(NamedTuple):
    first: float
    second: float


class Chosen(NamedTuple):
    pair: Pair
    number: int
    on: bool


class Way(NamedTuple):
    apply: Any
    none: Any


def arithmetic_of_floats(a: float, b: float) -> float:
    """Names that C++ has for itself are kept apart, too. \\"""
    double, register, end_, end, real, at = a + b, a - b, a * b, -a, +b, b
    return (double * register - end_ + end) * 0.5 + (real - at) + LIMIT * -1.5


def division(a: float, b: float) -> float:
    return a / b if b != 0.0 else 0.0


def division_of_whole_numbers(m: int, n: int) -> float:
    small_m, small_n = m % 1000000, n % 1000 + 1
    return small_m / small_n


def floor_division(m: int, n: int) -> int:
    return m // n if n != 0 else 7


def remainder(m: int, n: int) -> int:
    return m % n if n != 0 else 7


def signs(a: float, m: int) -> float:
    return -(-a) - (--a) + (++a) - (-m) * 1.0  # noqa: B002 - C++ has them


def whole_numbers_of_64_bits(m: int) -> int:
    """A product of two that are written down, and what they are handed on as, has more than 32."""
    big = 100000 * 100000 + 2147483647 * 2
    return (m & 1048575) * squared(100000) + big + squared(-65536) + (1 << 40)


def squared(n):
    return n * n


def bits(m: int, n: int) -> int:
    by = n & 31
    return (m & 4095 ^ n | 3) + ((m & 65535) << by) - (m >> by) + (m >> 3) + ~n


def truths(a: float, b: float, m: int) -> int:
    above = a > b
    other = not above
    both = above and m > 0
    either = (other or both) and not (m == 3 or a != a)
    return (1 if both else 0) + (2 if either else 0) + (4 if not m else 0)


def truths_of_whole_numbers(m: int, n: int) -> int:
    result = 0
    if (m and n % 3) or not (m or n):
        result = 1
    while m and result < 5:
        result += 3
    return result if n else -result


def kept_truths(a: float, m: int) -> int:
    sound = True
    sound = sound and a > 0.0
    sound = sound or bool(m)
    return 1 if sound else 0


def comparisons(a: float, b: float, m: int) -> int:
    count = 0
    if a < b <= LIMIT:
        count += 1
    if a <= b < 1.0 < m:
        count += 10
    if m == a:
        count += 100
    if a != b and m >= b > 0:
        count += 1000
    return count


def numbers_of_both_kinds(a: float, m: int, on: bool) -> float:
    small = m % 1000
    return (small if on else a) + (2 if a > 0.0 else 0.5) + small * a


def branches(a: float, m: int) -> float:
    if a > 1.0:
        part = a * 2.0
        value = part + 1.0
    elif m > 3:
        value = a - 1.0
    else:
        value = 0.0
        if a < -1.0:
            value = -1.0
            value -= a
    return value


def returns_in_branches(a: float) -> float:
    if a > 1.0:
        return 1
    if a > 0.5:
        return a
    if a != a:
        return INFINITE
    return -0.0


def chained_assignment(a: float, m: int) -> float:
    first = second = a + 1.0
    table = (5.0, 7.0, 11.0)
    i = j = k = m % 3
    first += i
    second -= j + k
    return first * second + (table[0] if i == 0 else table[2])


def swapped(a: float, b: float) -> float:
    a, b = b, a
    c, d = a + b, a - b
    c, a, d = d, c, a * c
    (a, b), c = (b, c), d
    _, e = c, a
    return a + 2.0 * b + 3.0 * c + 5.0 * d + 7.0 * e


def in_place(a: float, b: float, m: int) -> float:
    a += b
    a *= 1.5
    a -= b * b
    a /= 3.0
    n = m % 1000
    n *= 7
    n -= 3
    n //= 2
    n %= 5
    n <<= 2
    n |= 1
    n ^= 6
    n &= 255
    n >>= 1
    return a + n


def tuples(a: float, m: int) -> float:
    pair = (a, m % 7)
    numbers = (1.0, *pair)
    more = (*numbers, *(2.0, a))
    first, second, third = numbers
    angle, over, under = octant(abs(a), 1.0 + a * a)
    rest = (over, under)
    return sum_of_five(*more) + first + second * third + pair[0] + pair[1] + product_of(angle, *rest)


def sum_of_five(a, b, c, d, e):
    return a + 2.0 * b + 3.0 * c + 4.0 * d + 5.0 * e


def product_of(a, b, c):
    return a * b - c


def named_tuples(a: float, m: int, on: bool) -> float:
    chosen = Chosen(Pair(a, minimum(a, 1.0)), m % 5, on)
    other = chosen.pair
    first, second = other
    swapped_pair = pair_of(second, first)
    kept = swapped_pair.first if chosen.on else chosen.pair.second
    return kept + chosen.number + swapped_pair.second * chosen.pair.first


def pair_of(a, b):
    return Pair(a, b)


def while_loop(a: float) -> int:
    count, rest = 0, minimum(abs(a), 1e6)
    while rest > 1.0:
        rest *= 0.5
        count += 1
        if count == 12:
            break
        if count % 2 == 0:
            continue
        rest -= 0.25
    return count


def loops_over_ranges(m: int, n: int) -> int:
    total, low, high = 0, m % 10 - 5, n % 10
    for i in range(high):
        for j in range(low, i):
            if j == 3:
                continue
            if total > 1000:
                break
            total += i * 7 - j
        high = 2  # the range was made before
    for i in range(high, low):
        total -= i
    return total


def loops_over_numbers(a: float) -> float:
    total = 0.0
    for factor in (1.0, 0.5, 3):
        total = total * factor + a
    for place in (3, 0, 2):
        total += WEIGHTS[place] * PLACES[place]
    return total


def tables_of_numbers(m: int) -> float:
    i = m % 4
    return WEIGHTS[i] + WEIGHTS[3] * PLACES[PLACES[1]] + len(WEIGHTS) + HOLD + COUNT + arithmetic._E3


def built_in_functions(a: float, m: int) -> float:
    size = minimum(abs(a), 1e15)
    whole = max(m % 9, 4) + abs(m % 5 - 2) + select(bool(m), 1, 0)
    return size + int(size) + round(size) + float(m % 100) + whole


def rounded(a: float) -> int:
    return round(clamp(a, -9e18, 9e18))


def rounded_whole_number(m: int) -> int:
    return round(m) + int(m % 3) + abs(-m // 2)  # noqa: RUF057


def cut_off(a: float) -> int:
    return int(clamp(a, -9e18, 9e18))


def header_functions(a: float, b: float) -> float:
    size = minimum(abs(a), 1e100)
    return sqrt(size) + floor(clamp(b, -1e9, 1e9)) + select(a > b, a, b) + maximum(a, b) * minimum(b, a)


def fused(a: float, b: float, c: float) -> float:
    return fma(a, b, c) + exp(-abs(c))


def constants(a: float) -> float:
    small, smallest, largest = 1e-7, 5e-324, 1.7976931348623157e308
    return (a + small) * 1e22 - smallest + (largest if ON else -largest) * 1e-300 + (ENORMOUS // 1024) * 1e-9


def annotated(a: float) -> float:
    value: float = a
    for _ in range(3):
        value = value * 0.5 + 1.0
    return value


def _twice(a):
    return 2.0 * a


def _half(a):
    return 0.5 * a


def _nothing(a):
    return 0.0


WAYS = (Way(_twice, _nothing), Way(_half, _nothing), Way(_nothing, _twice))


def choice(a: float, m: int) -> float:
    return WAYS[m % 3].apply(a) + WAYS[m % 2].none(a)


def on_records(points: Sequence[Any], values: Any, table: Any, n: int) -> None:
    """Fields, members of arrays with one index and two, rows, slices, arrays that are handed on."""
    points[0].x += values[n] * table[n, 1]
    points[1].count += 3
    points[1].table[n] = points[0].x
    points[2].x = points[2].counts[n] + points[1].table[points[1].count % 3]
    of_32_bits = points[2].counts[n + 2]
    points[2].x += of_32_bits * of_32_bits
    rest = points[1:3]
    rest[1].count = len(values) + len(table)
    row = table[n]
    row[0] = total_of(row) + total_of(values[n : n + 2])
    table[moved(points[0]), 0] -= 1.0
    values[moved(points[0])] *= 3.0
    first = second = points[0]
    first.x = second.x * 2.0
    points[0].x = points[0].x + changed(points[0])
    points[0].x += changed(points[0])


def total_of(numbers):
    total = 0.0
    for i in range(len(numbers)):
        total += numbers[i]
    return total


def moved(point):
    """Return a place, and that of the next time is another."""
    point.count = (point.count + 1) % 2
    return point.count


def changed(point):
    point.x = point.x * 0.5 + 1.0
    return point.x
