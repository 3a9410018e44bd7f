"""A rail whose cleaned share counts as it is: friction is the mean of that of the rail as found and clean."""

from uictest.core.physics import cleaned_share
from uictest.core.rail_laws.law import RailLaw


def clean_part(share: float) -> float:
    """Return the cleaned share itself."""
    return share


LAW = RailLaw(
    name="mixture",
    description="Friction is in proportion to the cleaned share.",
    own_share=cleaned_share,
    clean_part=clean_part,
)
