"""The cover of the dossier: which build, what its self-test says, what that means, and what lies inside."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from markupsafe import escape

from uictest import __version__
from uictest.core.document import Column, Table
from uictest.report import counted
from uictest.selftest.dossier.build import identity
from uictest.selftest.dossier.sheet import Section, sheet
from uictest.selftest.dossier.sources import KINDS
from uictest.selftest.findings import Examination

_TITLES: Final = {
    "questions.html": "Questions of an assessor, answered, each with its place",
    "manual/trust.html#what-a-verdict-does-not-say": "What a verdict does not say",
    "known-answers.html": "Self-test: what was expected and found",
    "manual/requirements.html": "Requirements of the tool with their tests, constraints on use",
    "manual/tool-errors.html": "Error analysis: how each function could lie, what detects it, what remains",
    "manual/known-errors.html": "Known errors",
    "manual/trust.html": "Purpose, domain, verification, uncertainty, configuration control",
    "public-sources.html": "Public sources beside the rig: bias, spread and every miss",
    "studies.html": "Studies and their results, misses first",
    "numbers.html": "Every number of the library with mark, source and range; the limits of all criteria",
    "tests.html": "Tests that requirements and error analysis name, with their files",
    "materials.html": "Installed packages with versions and licences",
}
"""What an assessor opens first -> what it is; the rest follows by name."""


def cover(
    examination: Examination,
    facts: Mapping[str, str],
    sources: Sequence[Mapping[str, Any]],
    names: Sequence[str],
) -> str:
    """Return the first page: which build, how its self-test ended, what that means, a link to every part.

    Args:
        examination: the self-test.
        facts: on the installation, by name; those without a text are left out.
        sources: what public sources say of the rig.
        names: of all files but this one and `dossier.json`.
    """
    opened = {target.partition("#")[0] for target in _TITLES}
    rest = ["dossier.json", *sorted(set(names) - opened), "SHA256SUMS"]
    first = [(target, title) for target, title in _TITLES.items() if target.partition("#")[0] in names]
    items = "".join(f'<li><a href="{target}">{escape(title)}</a></li>' for target, title in first)
    others = "".join(f'<li><a href="{name}">{name}</a></li>' for name in rest)
    table = Table(
        [
            Column(heading="what", text=lambda each: each[0], literal=True),
            Column(heading="is", text=lambda each: each[1], wraps=True),
        ],
        [each for each in facts.items() if each[1]],
    )
    return sheet(
        _headline(examination),
        [Section("Installation", table)],
        said=[identity(), *meaning(sources)],
        body=f"<h2>Read first</h2><ul>{items}</ul><h2>All other files</h2><ul>{others}</ul>",
        home="",
        subline=f"Dossier of uictest {__version__} for an assessor",
    )


def _headline(examination: Examination) -> str:
    statuses = [each.status for each in examination.findings]
    counts = ", ".join(f"{statuses.count(each)} {each}" for each in dict.fromkeys(statuses))
    failed = examination.status in ("fail", "error")
    return f"{'FAILED' if failed else 'Passed'}: {counted(len(statuses), 'check')} of the self-test, {counts}"


def meaning(sources: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Yield what a passed self-test means, and what other evidence says of the rig, in sentences."""
    yield (
        "Passing means that this installation computes what that of the authors computed, and agrees with "
        "some closed forms. It validates nothing."
    )
    holding = [each for each in sources if each["result"] == "holds"]
    held = "".join(f" ({each['title']}: {KINDS[each['kind']]})" for each in holding)
    missed, predicted = (sum(each[key] for each in sources) for key in ("missed", "predicted_numbers"))
    yield (
        f"Public sources: {len(holding)} of {len(sources)} {'holds' if len(holding) == 1 else 'hold'}{held}, "
        f"{len(sources) - len(holding)} miss; of {counted(predicted, 'predicted number')} {missed} miss."
    )
    for each in sources:
        if each["kind"] == "measured":
            yield f"{each['title']}: {_predictions(each)}."
    yield "Independent verification: none."


def _predictions(source: Mapping[str, Any]) -> str:
    predicted = [each for each in source["numbers"] if each["status"] == "predicted"]
    words = ", ".join(
        f"{each['quantity']} {each['difference_percent']:+.1f} % ({each['result']})" for each in predicted
    )
    missed = sum(each["result"] == "misses" for each in predicted)
    verb = "miss" if missed != 1 else "misses"
    return f"{missed} of {counted(len(predicted), 'predicted number')} {verb}: {words}"
