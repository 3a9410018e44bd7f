"""The page of a source, and the table of all sources."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from validation.source import TOLERANCE, Agreement, Comparison, Validation

_KINDS: Final = {
    "measured": "measurement",
    "tabulated": "design table",
    "computed": "other theory",
    "second-hand": "text, second-hand",
}


def page(validation: Validation) -> str:
    """Return the page of a source."""
    source, comparisons = validation.source, validation.findings.comparisons
    return "\n".join(
        (
            f"# {source.title}\n",
            f"- **Source** ({_KINDS[source.kind]}): {source.place}.",
            f"- **Fitted**: {source.fitted}.",
            f"- **It shows**: {source.shows}",
            f"- **It does not show**: {source.does_not_show}\n",
            f"{_summary(validation)}\n",
            *_rows(comparisons),
            "",
            *(f"{note}\n" for note in validation.findings.notes),
            "Repeat it, offline, in a checkout:\n",
            f"    python -m validation {source.name}\n",
        )
    )


def _summary(validation: Validation) -> str:
    predicted = validation.predicted
    text = f"Predicted: {predicted.missed} of {predicted.count} miss. Fitted: {validation.fitted}."
    if predicted.bias is not None:
        text += f" Bias {_percent(predicted.bias)}, spread {_percent(predicted.spread, signed=False)}."
    return text


def _rows(comparisons: Sequence[Comparison]) -> Iterator[str]:
    """Yield the lines of the table, predicted numbers that miss first."""
    yield "| quantity | source | here | difference | status | result |"
    yield "|---|---|---|---|---|---|"
    for each in sorted(comparisons, key=lambda each: each.fitted or each.result != "misses"):
        status = "fitted" if each.fitted else "predicted"
        cells = (each.quantity, _of_source(each), _ours(each), _percent(each.difference), status, each.result)
        yield f"| {' | '.join(cells)} |"


def _of_source(comparison: Comparison) -> str:
    digits, source = comparison.digits, comparison.source
    text = (
        f"{source[0]:.{digits}f} to {source[1]:.{digits}f}"
        if isinstance(source, tuple)
        else f"{source:.{digits}f}"
    )
    return f"{text} {comparison.unit}".rstrip()


def _ours(comparison: Comparison) -> str:
    if comparison.here is None:
        return "not modelled"
    return f"{comparison.here:.{comparison.digits}f} {comparison.unit}".rstrip()


def _percent(value: float | None, *, signed: bool = True) -> str:
    if value is None:
        return "-"
    return f"{value:+.1f} %" if signed else f"{value:.1f} %"


def overview(validations: Sequence[Validation]) -> str:
    """Return the table of all sources, those that miss first."""
    return "\n".join(
        (
            "# Validation against public sources\n",
            "Numbers that others published, beside those of this rig. No train was measured for it.\n",
            (
                f"A number holds within {TOLERANCE:g} % of the source's (chosen, one bound for all), a "
                "range if ours lies inside. What is not modelled misses. Bias is the mean and spread the "
                "standard deviation of the differences of what was *predicted*; what something was fitted "
                "to is only counted. Ranges have no bias.\n"
            ),
            "| source | what it is | predicted | missed | fitted | bias | spread | worst |",
            "|---|---|---|---|---|---|---|---|",
            *(_overview_row(each) for each in misses_first(validations)),
            "",
            (
                "Left out: braked weight (EN 16834) and the conversion model of SUBSET-026, which are "
                "definitions, and closed forms of single parts, which the "
                "[tests](../docs/trust.md#what-the-tests-state) hold.\n"
            ),
            "The pages and this table are written by\n",
            "    python -m validation\n",
            "which needs a checkout and no network, and is checked by a test.\n",
        )
    )


def misses_first(validations: Sequence[Validation]) -> list[Validation]:
    """Return the validations in order of the share that misses, greatest first."""
    return sorted(validations, key=lambda each: -each.predicted.missed / max(each.predicted.count, 1))


def _overview_row(validation: Validation) -> str:
    source, found = validation.source, validation.predicted
    cells = (
        f"[{source.title}]({source.name}.md)",
        _KINDS[source.kind],
        f"{found.count}",
        f"**{found.missed}**" if found.missed else "0",
        f"{validation.fitted}",
        _percent(found.bias),
        _percent(found.spread, signed=False),
        _worst(found),
    )
    return f"| {' | '.join(cells)} |"


def _worst(found: Agreement) -> str:
    if found.worst is None:
        return "-"
    return f"{found.worst.quantity}: {_ours(found.worst)} against {_of_source(found.worst)}"
