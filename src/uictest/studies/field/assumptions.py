"""What the paper leaves open of the real train's stop: rail, cleaning, brake, and the start of the clock."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

DRY: Final = 0.30
"""No wheelset slides at this friction, whatever the pads: more friction changes nothing."""
Shape = Literal["constant", "dry first", "dry last"]
"""Friction along the track: the same everywhere, or slippery beyond a place or up to it."""
SHAPES: Final[tuple[Shape, ...]] = ("constant", "dry first", "dry last")
Brake = Literal["ep-disc", "distributor"]
"""A brake system of the library."""


@dataclass(frozen=True, slots=True)
class Assumptions:
    """One set of assumptions.

    Args:
        shape: of the friction along the track.
        friction: of the slippery track as it is found.
        place: where the friction changes, m from the brake command; without meaning where it is constant.
        brake: the brake system, which gives the dead time.
        fill_time: in which its pressure builds up, s.
        pad_factor: pad friction over the rig's: the paper does not give the brake force of the real train.
        cleaning_energy: that cleans the rail, J/m; None: sliding does not clean it.
        carry_over: of what a wheelset has cleaned, the share that the next one finds.
        lead: time from the brake command to the start of the clock, s.
    """

    shape: Shape
    friction: float
    place: float
    brake: Brake
    fill_time: float
    pad_factor: float = 1.0
    cleaning_energy: float | None = None
    carry_over: float = 0.0
    lead: float = 0.0

    def __str__(self) -> str:
        """Return the assumptions in words."""
        parts = [
            self._rail(),
            f"pads x {self.pad_factor:.2f}",
            f"{self.brake}, {self.fill_time:.1f} s to fill",
        ]
        if self.cleaning_energy is not None:
            energy = f"{self.cleaning_energy / 1e3:.1f} kJ/m"
            parts.insert(1, f"cleaned at {energy} with carry-over {self.carry_over:g}")
        if self.lead:
            parts.append(f"commanded {self.lead:.2f} s before the clock starts")
        return ", ".join(parts)

    def _rail(self) -> str:
        friction = f"friction {self.friction:.3f}"
        if self.shape == "constant":
            return f"{friction} everywhere"
        dry = f"dry {'up to' if self.shape == 'dry first' else 'beyond'} {self.place:.0f} m"
        return f"{dry}, {friction} {'beyond' if self.shape == 'dry first' else 'before'}"
