"""The parts that a page shows in full."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from uictest.judging import evaluation
from uictest.report.part_wording import base_word, changed_parameters, part_sentences

_MOST: Final = 100
"""Parts that a page shows: each takes up to 10 kB of it."""

PARAMETER_WORDS: Final[dict[str, Any]] = {
    "base_word": base_word,
    "changed_parameters": changed_parameters,
    "part_sentences": part_sentences,
}
"""What parameters.html.j2 puts parts into words with."""


@dataclass(frozen=True, slots=True)
class ShownParts:
    """The parts that a page shows in full, and how many more there are that it does not show."""

    parts: Sequence[evaluation.EffectivePart]
    not_shown: int

    def __contains__(self, part: evaluation.EffectivePart) -> bool:
        """Whether the page shows a part, so that a link to it leads somewhere."""
        return any(each.id == part.id for each in self.parts)


def shown_parts(cases: Iterable[Mapping[str, evaluation.EffectivePart]]) -> ShownParts:
    """Return the distinct parts of some cases in the order of their first use, for a page to show."""
    parts = list(evaluation.parts_table(cases).values())
    return ShownParts(parts[:_MOST], max(len(parts) - _MOST, 0))
