"""Types of the arrays that identification computes with."""

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.float64]
"""Samples of one channel in SI units."""
Mask = NDArray[np.bool_]
"""For each sample of a record, whether something holds there."""
