"""How well a number of trials knows a probability."""

from __future__ import annotations

import math


def proportion_interval(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the interval of Clopper and Pearson (1934) for a probability, of which `successes` were counted.

    It contains the probability at least with this confidence, half of the rest on each side, whatever the
    probability and however few the trials. Raises ValueError for counts that cannot be.
    """
    if not 0 <= successes <= trials or trials < 1:
        raise ValueError(f"{successes} successes in {trials} trials")
    from scipy.special import betaincinv

    alpha = 1.0 - confidence
    low = 0.0 if successes == 0 else betaincinv(successes, trials - successes + 1, alpha / 2)
    high = 1.0 if successes == trials else betaincinv(successes + 1, trials - successes, 1 - alpha / 2)
    return float(low), float(high)


def trials_needed(probability: float, confidence: float = 0.95) -> int | None:
    """Return the fewest trials whose interval lies at or above `probability` if all of them succeed.

    None for a probability of 1, which no number of trials can show.
    """
    if probability >= 1.0:
        return None
    if probability <= 0.0:
        return 1
    # The lower end with n successes in n trials is (alpha / 2) ** (1 / n).
    return max(math.ceil(math.log((1.0 - confidence) / 2) / math.log(probability) - 1e-9), 1)
