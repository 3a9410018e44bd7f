"""Reproducible sensor noise: a counter-based generator, so that no draw depends on how work was split.

Threefry-2x32 with 20 rounds: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC'11
(2011). The key is the seed and the case, the counter the sample and the channel.
"""

_MASK = 0xFFFFFFFF
_PARITY = 0x1BD11BDA
_HALF_WORD = 0xFFFF
_SCALE = 1.0 / 65536.0
_UNIT_VARIANCE = 1.7320508075688772


def threefry(key_0: int, key_1: int, counter_0: int, counter_1: int) -> tuple[int, int]:
    """Two 32-bit words of random bits for a key and a counter of two 32-bit words each."""
    key_2 = _PARITY ^ key_0 ^ key_1
    x = (counter_0 + key_0) & _MASK
    y = (counter_1 + key_1) & _MASK
    x, y = _four_rounds(x, y, 13, 15, 26, 6)
    x, y = (x + key_1) & _MASK, (y + key_2 + 1) & _MASK
    x, y = _four_rounds(x, y, 17, 29, 16, 24)
    x, y = (x + key_2) & _MASK, (y + key_0 + 2) & _MASK
    x, y = _four_rounds(x, y, 13, 15, 26, 6)
    x, y = (x + key_0) & _MASK, (y + key_1 + 3) & _MASK
    x, y = _four_rounds(x, y, 17, 29, 16, 24)
    x, y = (x + key_1) & _MASK, (y + key_2 + 4) & _MASK
    x, y = _four_rounds(x, y, 13, 15, 26, 6)
    return (x + key_2) & _MASK, (y + key_0 + 5) & _MASK


def _four_rounds(x: int, y: int, r0: int, r1: int, r2: int, r3: int) -> tuple[int, int]:
    x, y = _round(x, y, r0)
    x, y = _round(x, y, r1)
    x, y = _round(x, y, r2)
    return _round(x, y, r3)


def _round(x: int, y: int, rotation: int) -> tuple[int, int]:
    x = (x + y) & _MASK
    y = ((y << rotation) | (y >> (32 - rotation))) & _MASK
    return x, x ^ y


def uniform(words: tuple[int, int]) -> float:
    """Number between 0 and 1 from the first of two words of random bits."""
    return (words[0] + 0.5) * (_SCALE * _SCALE)


def bell(word_0: int, word_1: int) -> float:
    """Bell-shaped number of mean 0 and variance 1, within +-3.47: the scaled sum of four uniform numbers.

    Bounded, as a sensor's noise is, and free of logarithms.
    """
    total = (word_0 & _HALF_WORD) + (word_0 >> 16) + (word_1 & _HALF_WORD) + (word_1 >> 16)
    return ((total + 2.0) * _SCALE - 2.0) * _UNIT_VARIANCE
