"""The page of the self-test: what was expected, by what origin, what was found, of which requirement."""

from __future__ import annotations

from collections import Counter
from typing import Final

from uictest.core.document import Column, Lines, Table
from uictest.selftest.dossier.sheet import Section, sheet
from uictest.selftest.findings import Examination, Finding, finding_document

_REQUIREMENTS: Final = {
    "numerics": "TOOL-11",
    "physics": "TOOL-51",
    "lanes": "TOOL-10",
    "judging": "TOOL-6, TOOL-35",
    "controllers": "TOOL-25",
    "environment": "TOOL-13",
    "cache": "TOOL-32",
}
"""Group of a check, or its own name where it is of another requirement -> what it checks of the tool."""


def answers_page(examination: Examination) -> str:
    """Return the page of all checks, what is not as it should be first."""
    _, table, remarks = finding_document(examination).sections
    assert isinstance(table, Table)
    assert isinstance(remarks, Lines)
    origins = Counter(each.origin for each in examination.findings)
    said = (
        "Within is the largest difference that passes, as a share of what is expected. Expected by origin: "
        f"{', '.join(f'{origin} {count}' for origin, count in origins.most_common())}. Only closed forms and "
        "publications are true without this program."
    )
    return sheet(
        "Self-test", [Section("Known answers", _with_origin(table), before=(said, *remarks.sentences))]
    )


def _with_origin(table: Table) -> Table:
    *columns, what = table.columns
    origin: Column[Finding] = Column(heading="expected from", text=lambda each: each.origin)
    requirement: Column[Finding] = Column(heading="requirement", text=requirements_of)
    is_known: Column[Finding] = Column(heading="what is checked", text=what.text, wraps=True)
    return Table([*columns, origin, requirement, is_known], table.rows)


def requirements_of(finding: Finding) -> str:
    """Return the numbers of the requirements that a check belongs to."""
    return _REQUIREMENTS.get(finding.id) or _REQUIREMENTS[finding.group]
