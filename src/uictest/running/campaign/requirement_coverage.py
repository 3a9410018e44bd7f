"""Which scenarios, series and criteria verify which requirements, as far as files alone can tell."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Literal

from uictest.plans import scenario
from uictest.plans.series import Series

VerifierKind = Literal["scenario", "series", "criterion"]


@dataclass(frozen=True, slots=True)
class Verifier:
    """A scenario, a series file, or a criterion of a profile, that names a requirement.

    Args:
        kind: which of them.
        name: of the scenario or series file, or id of the criterion.
        profile: of the criterion; empty for a scenario or series.
        cases: ids of the cases that the requirement is verified in; for a criterion those that it applies to.
        series: ids of the series that it is verified in.

    """

    kind: VerifierKind
    name: str
    profile: str = ""
    cases: tuple[str, ...] = ()
    series: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class CoveredRequirement:
    """A requirement and what verifies it; it is covered where that happens in a case or a series."""

    id: str
    verifiers: tuple[Verifier, ...] = ()

    @property
    def covered(self) -> bool:
        """Whether any case or series verifies it."""
        return any(verifier.cases or verifier.series for verifier in self.verifiers)


def requirement_coverage(
    cases: Iterable[scenario.Case], listed: Sequence[str] = (), series: Iterable[Series] = ()
) -> list[CoveredRequirement]:
    """Return the requirements that cases, series or their criteria name, and those `listed`, by their ids.

    A criterion does not verify anything in a case or series that is not expected to pass, or that it does not
    apply to; one that only a series can be judged by verifies nothing in any case. A series does not verify
    what the scenarios of its stops name.
    """
    found: dict[str, list[Verifier]] = {requirement: [] for requirement in listed}
    for requirement, verifier in chain(*map(_named_in_case, cases), *map(_named_in_series, series)):
        found.setdefault(requirement, []).append(verifier)
    return [
        CoveredRequirement(each, _merged_verifiers(found[each])) for each in scenario.in_order_of_ids(found)
    ]


def _named_in_case(case: scenario.Case) -> Iterator[tuple[str, Verifier]]:
    """Yield each requirement that a case or a criterion names, with what names it; its case if verified."""
    for requirement in case.scenario.requirements:
        yield requirement, Verifier("scenario", case.scenario.name, cases=(case.id,))
    for profile in case.scenario.criteria:
        for criterion in profile.criteria:
            if criterion.requirements:
                applies = not criterion.needs_series and scenario.applies_to(criterion, case.scenario)
                verified = (case.id,) if applies and case.scenario.expect.outcome == "pass" else ()
                for requirement in criterion.requirements:
                    yield requirement, Verifier("criterion", criterion.id, profile.name, cases=verified)


def _named_in_series(series: Series) -> Iterator[tuple[str, Verifier]]:
    """Yield each requirement that a series or a criterion names, as for a case."""
    for requirement in series.file.requirements:
        yield requirement, Verifier("series", series.file.name, series=(series.id,))
    for profile in series.criteria:
        for criterion in profile.criteria:
            verifies = series.file.expect.outcome == "pass" and _has_verdict_on(series, criterion)
            verified = (series.id,) if verifies else ()
            for requirement in criterion.requirements:
                yield requirement, Verifier("criterion", criterion.id, profile.name, series=verified)


def _has_verdict_on(series: Series, criterion: scenario.Criterion) -> bool:
    """Return whether a series has a verdict on a criterion that applies to one of its stops at least."""
    if criterion.id not in {each.id for _, each in series.judged_criteria}:
        return False
    roles = ("wet",) if criterion.needs_series else ("dry", "wet")
    judged = (stop.case for stop in series.stops if stop.role in roles)
    return any(scenario.applies_to(criterion, case.scenario) for case in judged)


def _merged_verifiers(named: Iterable[Verifier]) -> tuple[Verifier, ...]:
    """Return one verifier for each kind, name and profile, with the places of all that have these."""
    groups: dict[tuple[VerifierKind, str, str], list[Verifier]] = {}
    for each in named:
        groups.setdefault((each.kind, each.name, each.profile), []).append(each)
    return tuple(
        Verifier(
            *key,
            cases=tuple(case for each in group for case in each.cases),
            series=tuple(name for each in group for name in each.series),
        )
        for key, group in groups.items()
    )
