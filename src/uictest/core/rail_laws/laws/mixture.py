"""A rail whose cleaned share counts as it is: friction is the mean of that of the rail as found and clean."""

from collections.abc import Sequence

from uictest.core.rail_laws.law import RailLaw, cleaned_by_energy


def clean_part(share: float, numbers: Sequence[float]) -> float:
    """Return the cleaned share itself."""
    return share


LAW = RailLaw(
    name="mixture",
    description="Friction is in proportion to the cleaned share.",
    own_share=cleaned_by_energy,
    clean_part=clean_part,
)
