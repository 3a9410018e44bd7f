"""The rail: friction along the track and in time, and how sliding wheels clean it.

Sliding wheels clean the rail, and what follows runs on what they have cleaned. A wheelset that loses W joules
per metre of track to its contacts cleans the rail under it,

    dc/dx = (1 - exp(-W / Wc) - c) / reach

and leaves C = 1 - (1 - c) (1 - k C'), where C' is the share that the wheelset before it has left at the same
place and k the part of it that lasts until then. Friction rises with the cleaned share from mu0 towards the
friction mur of a clean rail: mu0 + C (mur - mu0). It never falls.

That sliding cleans the rail to the benefit of the wheelsets behind is published (Allotta, Meli, Ridolfi and
Rindi, Tribology International 69 (2014) 128; Voltr and Lata, Vehicle System Dynamics 53 (2015) 605). This
form of the equations is ours.
"""

from collections.abc import Sequence
from typing import Final

from uictest.core.physics.arithmetic import exp, maximum, minimum

MOST_SAND_POINTS: Final = 16
"""Points that a table of what sand does may have."""


def interpolated(at: float, places: Sequence[float], values: Sequence[float], count: int) -> float:
    """Value at ``at`` of a piecewise linear law through ``count`` points, constant beyond its ends.

    Two points at the same place make a step; the value there is that of the later point.
    """
    if at < places[0]:
        return values[0]
    i = 0
    while i + 1 < count and places[i + 1] <= at:
        i += 1
    if i + 1 >= count:
        return values[count - 1]
    share = (at - places[i]) / (places[i + 1] - places[i])
    return values[i] + share * (values[i + 1] - values[i])


def log_normal_factor(deviation: float, log_spread: float) -> float:
    """Factor of mean 1 whose logarithm has a normal distribution.

    Args:
        deviation: normal, of mean 0 and variance 1.
        log_spread: standard deviation of the logarithm.
    """
    logarithm = log_spread * deviation - 0.5 * log_spread * log_spread
    return exp(minimum(logarithm, 0.0)) / exp(minimum(-logarithm, 0.0))


def cleaned_share(share: float, loss: float, distance: float, response: float, decay: float) -> float:
    """Share of the rail that a wheelset itself has cleaned, c, at the end of a stretch of track.

    The loss per metre is constant over the stretch, for which the equation is solved exactly.

    Args:
        share: c at its beginning.
        loss: energy turned into heat in the contacts of both wheels on the way, J.
        distance: length of the stretch, > 0, m.
        response: 1 / Wc, m/J.
        decay: 1 / reach, 1/m.
    """
    settled = 1.0 - exp(-response * maximum(loss / distance, 0.0))
    return settled + (share - settled) * exp(-decay * distance)


def share_left_behind(share: float, arrived: float, carry_over: float) -> float:
    """Cleaned share of the rail under and behind a wheelset, C.

    Args:
        share: c, what the wheelset itself has cleaned.
        arrived: C', what the wheelset before it has left at this place.
        carry_over: k.
    """
    return 1.0 - (1.0 - share) * (1.0 - carry_over * arrived)


def cleaned_friction(friction: float, share: float, recovered_friction: float) -> float:
    """Initial friction coefficient of a rail of which a share is clean; a better rail keeps its own.

    Args:
        friction: mu0 of the rail as it is found.
        share: C.
        recovered_friction: mur.
    """
    return friction + share * maximum(recovered_friction - friction, 0.0)
