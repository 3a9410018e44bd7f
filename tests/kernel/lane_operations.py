"""Operations on numbers of lanes, on one lane, and on records in lanes."""

from uictest.core.physics import mass_flow, orifice_law
from uictest.core.physics.arithmetic import floor, fma, maximum, minimum, select, sqrt
from uictest.core.physics.sensors import bell, threefry
from uictest.rig.kernel.arguments import copy_from_lane, copy_to_lane, lane, vectors

CRITICAL, SCALE, SLOPE = orifice_law(0.35, 0.995)


def on_floats(block):
    """Set each field to what it is called after."""
    r = vectors(block)[0]
    r.add = r.a + r.b
    r.sub = r.a - r.b
    r.mul = r.a * r.b
    r.div = r.a / r.b
    r.minimum = minimum(r.a, r.b)
    r.maximum = maximum(r.a, r.b)
    r.less = select(r.a < r.b, 1.0, 0.0)
    r.less_equal = select(r.a <= r.b, 1.0, 0.0)
    r.greater = select(r.a > r.b, 1.0, 0.0)
    r.greater_equal = select(r.a >= r.b, 1.0, 0.0)
    r.equal = select(r.a == r.b, 1.0, 0.0)
    r.unequal = select(r.a != r.b, 1.0, 0.0)
    r.select = select(r.a > 0.0, r.a, r.b)
    r.both = select((r.a > 0.0) & (r.b > 0.0), r.a, r.b)
    r.either = select((r.a > 0.0) | (r.b > 0.0), r.a, r.b)
    r.neither = select(not ((r.a > 0.0) | (r.b > 0.0)), r.a, r.b)
    r.negative = -r.a
    r.size = abs(r.a)
    r.floor = floor(r.a)
    r.sqrt = sqrt(r.a)
    r.number_on_the_left = 3.0 - r.a
    r.number_on_the_right = r.a / 3
    r.rounded_twice = 1.0 - (1.0 + r.a) * (1.0 - r.a)
    r.not_reordered = (r.a + r.b) - r.a
    r.fused = fma(r.a, r.b, 0.5)
    r.in_place = r.a
    r.in_place += r.b
    r.in_place *= 2.0
    r.in_place -= r.a
    r.in_place /= r.b


def on_whole_numbers(block):
    """Set each field to what it is called after."""
    r = vectors(block)[0]
    r.add = r.a + r.b
    r.mul = r.a * r.b
    r.bit_and = r.a & r.b
    r.bit_or = r.a | r.b
    r.bit_xor = r.a ^ r.b
    r.left = r.a << 13
    r.right = r.b >> 13
    r.number_on_the_left = 0x1BD11BDA ^ r.a
    r.number_on_the_right = r.b + 5
    r.less = select(r.a < r.b, r.a, r.b)
    r.less_than_a_number = select(r.b < 3, r.a, 0)
    r.equal = select(r.a & 1 == r.b & 1, 7, r.a + 1)
    r.any_bit_is_true = select(r.a & 1, r.a, r.b)
    r.number = (r.a + 1.0) * 0.5
    r.counted = r.counted + 1
    word_0, word_1 = threefry(r.seed, r.place, r.cycle, 35)
    r.noise = bell(word_0, word_1)


def change_one_lane(block, number):
    """Change one record of one lane."""
    record = lane(block, number)[1]
    record.speed = -record.speed
    record.mode = (record.mode << 1) | 1
    record.load = 7.0
    record.load += record.speed


def fill(block):
    """A number that is stored into a vector fills every lane."""
    vectors(block)[0].load = 0.5
    vectors(block)[2].load = 3


def copy_there(block, records, number):
    """Copy a record into a lane."""
    copy_to_lane(lane(block, number)[2], records[0])


def copy_back(block, records, number):
    """Copy what a lane has into a record."""
    copy_from_lane(records[1], lane(block, number)[2])


def see_each_other(block, i, number):
    """A write is seen through every view of its field."""
    records = vectors(block)
    one = lane(block, number)
    records[0].load = records[0].speed
    one[i].speed = 50.0
    records[1].load = records[0].speed
    records[i].speed = records[i].speed + 1.0


def fused_one_by_one(numbers):
    """Write the fused products of rows of three."""
    for n in range(len(numbers)):
        numbers[n, 3] = fma(numbers[n, 0], numbers[n, 1], numbers[n, 2])


def flow_through_orifices(block):
    """Write the flow from one pressure to another, through an orifice of these numbers."""
    record = vectors(block)[0]
    record.add = mass_flow(record.a, record.b, 1.0, 1.0, 1e-8, CRITICAL, SCALE, SLOPE)
