"""Rows of the array that holds the friction of a rail; each is used up to its number of points.

The friction coefficient is linear between places, its factor is linear between times.
"""

PLACES = 0
"""Places along the track, m from the position of the leading wheelset at the brake command."""
FRICTIONS = 1
"""Friction coefficients at these places."""
TIMES = 2
"""Times since the brake command, s."""
FACTORS = 3
"""Factors of the friction coefficient at these times."""
ROWS = 4
