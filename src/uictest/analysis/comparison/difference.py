"""The result of a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from uictest.analysis.comparison.overlay import Overlay
from uictest.analysis.comparison.paired.document import paired_form
from uictest.analysis.comparison.paired.pairing import PairedComparison
from uictest.analysis.comparison.parameters import ParameterChange
from uictest.report import Difference, differences_form


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two things compared.

    Args:
        first, second: their names.
        compared: how many quantities were compared.
        differences: those that are not the same, within tolerance or not.
        notes: inputs, versions and settings that differ.
        overlays: plots of both sides.
        undrawn: which stops are not drawn, and why.
        parameters: those that differ between two runs.
        paired: differences of stops under the same noise, between two runs; None for recordings.

    """

    first: str
    second: str
    compared: int
    differences: Sequence[Difference]
    notes: Sequence[str] = ()
    overlays: Sequence[Overlay] = field(default=(), repr=False)
    undrawn: Sequence[str] = ()
    parameters: Sequence[ParameterChange] = ()
    paired: PairedComparison | None = None

    @property
    def beyond(self) -> list[Difference]:
        """The differences that are out of tolerance."""
        return [difference for difference in self.differences if not difference.within]

    @property
    def agrees(self) -> bool:
        """Whether everything is within tolerance."""
        return not self.beyond

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form, overlays left out."""
        return {
            "schema": "uictest/comparison/1",
            "first": self.first,
            "second": self.second,
            "agrees": self.agrees,
            "compared": self.compared,
            "notes": list(self.notes),
            "parameters": [_change_form(change) for change in self.parameters],
            "differences": differences_form(self.differences),
            **({} if self.paired is None else {"paired": paired_form(self.paired)}),
        }


def _change_form(change: ParameterChange) -> dict[str, Any]:
    first, second = change.texts
    return {"key": change.key, "first": first, "second": second, "cases": list(change.cases)}
