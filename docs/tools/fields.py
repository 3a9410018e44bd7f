"""Tables for the pages, generated from the program: units, measures, kinds of faults."""

from __future__ import annotations

from markup import table

from uictest.core.measures import MEASURES, Measure
from uictest.core.units import KINDS
from uictest.plans.faults import FAULT_KINDS, FaultKind
from uictest.plans.scenario import plausible_spans


def units_table() -> str:
    """Return every kind of quantity with the units accepted for it."""
    rows = [
        (kind.name, ", ".join(f"`{unit}`" for unit in kind.units)) for kind in KINDS.values() if not kind.bare
    ]
    return table(("quantity", "units"), rows)


def measures_table(of_wheelsets: bool) -> str:
    """Return the measures that a criterion can bound, of a stop or of each of its wheelsets."""
    rows = [
        (f"`{name}`" if measure.unit == "1" else f"`{name}`, {measure.unit}", _meaning_of(measure))
        for name, measure in MEASURES.items()
        if measure.of_wheelsets is of_wheelsets
    ]
    return table(("measure, unit", "meaning"), rows)


def _meaning_of(measure: Measure) -> str:
    """Return the meaning with the definitions needed, where the sentence does not name them."""
    needed = [f"`{name}`" for name in measure.definitions if f"`{name}`" not in measure.meaning]
    return f"{measure.meaning} ({', '.join(needed)})" if needed else measure.meaning


def plausible_table() -> str:
    """Return the derived quantities of a train, their plausible spans, and the likely mistake beyond."""
    rows = [
        (
            row["title"],
            f"{row['span'][0]} to {row['span'][1]} {row['unit'].removeprefix('1')}".rstrip(),
            row["above"].rstrip("?") or row["below"].rstrip("?"),
        )
        for row in plausible_spans().values()
    ]
    return table(("quantity", "plausible", "likely mistake"), rows)


def faults_table() -> str:
    """Return every kind of fault that a scenario can inject."""
    rows = [
        (f"`{kind.part}` `{kind.name}`", _value_of(kind), kind.description, kind.report)
        for kind in FAULT_KINDS.values()
    ]
    return table(("`part` `kind`", "`value`", "effect", "report"), rows)


def _value_of(kind: FaultKind) -> str:
    value = kind.value
    if value is None:
        return ""
    words = f"{value.at_least.partition(' ')[0]} to {value.at_most}"
    return f"{words}; without one {value.without}" if value.without else words
