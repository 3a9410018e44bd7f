"""Tables for the pages, generated from the program: units, measures, kinds of faults."""

from __future__ import annotations

from markup import table

from uictest.core.measures import MEASURES
from uictest.core.units import KINDS
from uictest.plans.fault_effects import FaultKind
from uictest.plans.faults import FAULT_KINDS
from uictest.plans.scenario import plausible_spans

_COURSES = {"grows": "grows", "falls": "falls", "settles": "stays"}


def units_table() -> str:
    """Return every kind of quantity with the units accepted for it."""
    rows = [
        (kind.name, ", ".join(f"`{unit}`" for unit in kind.units), f"`{kind.canonical}`")
        for kind in KINDS.values()
        if not kind.bare
    ]
    return table(("quantity", "units accepted", "kept as"), rows)


def measures_table() -> str:
    """Return the measures that a criterion can bound."""
    rows = [
        (
            f"`{name}`",
            "" if measure.unit == "1" else measure.unit,
            "each wheelset" if measure.of_wheelsets else "the stop",
            measure.meaning,
            _COURSES[measure.course],
            ", ".join(f"`{each}`" for each in measure.definitions),
        )
        for name, measure in MEASURES.items()
    ]
    return table(("measure", "unit", "of", "meaning", "until standstill it", "definitions it needs"), rows)


def plausible_table() -> str:
    """Return the derived quantities of a train, their plausible spans, and what these rest on."""
    rows = [
        (
            row["title"],
            f"{row['span'][0]} to {row['span'][1]} {row['unit'].removeprefix('1')}".rstrip(),
            row["above"].rstrip("?") or row["below"].rstrip("?"),
            f"{row['mark']}: {row['reason']}",
        )
        for row in plausible_spans().values()
    ]
    return table(("quantity", "plausible", "beyond it likely", "why"), rows)


def faults_table() -> str:
    """Return every kind of fault that a scenario can inject."""
    rows = [
        (f"`{kind.part}`", f"`{kind.name}`", _value_of(kind), kind.description, kind.report)
        for kind in FAULT_KINDS.values()
    ]
    return table(("part", "kind", "value", "what it does", "report"), rows)


def _value_of(kind: FaultKind) -> str:
    value = kind.value
    if value is None:
        return "none"
    words = f"{value.kind}, {value.at_least} to {value.at_most}"
    return f"{words}; without one {value.without}" if value.without else words
