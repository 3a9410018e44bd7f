"""A film that stays slippery where it has gaps: what is left of it counts more than the rail that is bare.

With a share C bare and a weight w of the film over that of the bare rail, the mean of both is

    part = C / (C + w (1 - C))

which is C for w = 1, and for large w stays near 0 until little of the film is left. Full-scale brake tests
found friction low on leaf layers that were partly removed (Lewis et al., Tribology International 185 (2023)
108529); this form is ours.
"""

from collections.abc import Sequence

from uictest.core.rail_laws.law import LawNumber, RailLaw, cleaned_by_energy


def clean_part(share: float, numbers: Sequence[float]) -> float:
    """Return how far friction has gone to that of a clean rail; `share` is bare."""
    weight = numbers[0]
    return share / (share + weight * (1.0 - share))


LAW = RailLaw(
    name="film",
    description="A film that stays slippery where it has gaps.",
    own_share=cleaned_by_energy,
    clean_part=clean_part,
    numbers={
        "weight": LawNumber(
            "number", "How many times as much the film counts as as much bare rail.", "1", "1000"
        )
    },
)
