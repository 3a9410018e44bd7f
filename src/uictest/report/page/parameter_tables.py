"""The parts that a page shows in full."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any, Final

from uictest.report.parameters import base_word, changed_parameters, part_sentences

if TYPE_CHECKING:
    from uictest.evaluation import EffectivePart

_MOST: Final = 100
"""Parts that a page shows: each takes up to 10 kB of it."""

PARAMETER_WORDS: Final[dict[str, Any]] = {
    "base_word": base_word,
    "changed_parameters": changed_parameters,
    "part_sentences": part_sentences,
}
"""What parameters.html.j2 puts parts into words with."""


def shown_parts(cases: Iterable[Mapping[str, EffectivePart]]) -> list[EffectivePart]:
    """Return the distinct parts of some cases, in the order of their first use."""
    from uictest.evaluation import parts_table

    return list(islice(parts_table(cases).values(), _MOST))
