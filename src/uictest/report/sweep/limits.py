"""What bounds the results of a sweep: the domain that was validated, and the survey step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from uictest.core.units import PERCENT
from uictest.judging.evaluation import Deviation
from uictest.report.counts import counted
from uictest.report.part_wording import deviation_text

_MOST_NAMED: Final = 6
"""Conditions that a note lists before the rest is counted."""


@dataclass(frozen=True, slots=True)
class OutsideCount:
    """The cases beyond what was validated in one condition; of numbers, `found` spans all of theirs."""

    cases: int
    deviation: Deviation


@dataclass(frozen=True, slots=True)
class SweepDomain:
    """How many cases lie outside of the domain of a validation.

    Args:
        validation: its name.
        sha256: of its file.
        outside: number of cases with any condition beyond it.
        conditions: those conditions, the one of most cases first; a case may be in several.

    """

    validation: str
    sha256: str
    outside: int
    conditions: tuple[OutsideCount, ...] = ()


def domain_notes(domain: SweepDomain | None, cases: int) -> Iterator[str]:
    """Yield how many of `cases` lie outside, and in what; nothing where nobody asked."""
    if domain is None:
        return
    among = f"{domain.outside} of {counted(cases, 'case')} outside of what {domain.validation} validated"
    shown = [f"{deviation_text(each.deviation)} in {each.cases}" for each in domain.conditions[:_MOST_NAMED]]
    more = len(domain.conditions) - len(shown)
    rest = f"; {counted(more, 'more condition')} in sweep.json" if more else ""
    yield f"{among}: {'; '.join(shown)}{rest}" if shown else among


_LEAST_NOTED: Final = 1e-4
"""Share below which biases are only counted."""


@dataclass(frozen=True, slots=True)
class SurveyBias:
    """What the survey step moves a measure by, as shares of its mean.

    Args:
        measure: its name.
        bias: of the mean over many stops, at most: the farther end of its 95 % interval, in the shipped case
            in which that is largest.
        case: this case.
        of_single_stops: what 95 % of the single stops of a shipped case differ by at most, in the case in
            which that is largest. Where WSP cycling makes stops differ anyway, this is mostly their scatter.

    """

    measure: str
    bias: float
    case: str
    of_single_stops: float


@dataclass(frozen=True, slots=True)
class SurveyStep:
    """The steps of a survey.

    Args:
        time_step: that the cases were simulated in, as written.
        regular_step: that those were repeated in of which a value lay within its bias of a limit, and those
            that the survey step could not simulate or decide, as written.
        repeated: number of these cases.
        biases: of the measures that are judged or mapped.
        unknown: names of those whose bias is not known: every case in which one is judged is repeated.

    """

    time_step: str
    regular_step: str
    repeated: int
    biases: tuple[SurveyBias, ...]
    unknown: tuple[str, ...] = ()


def survey_notes(survey: SurveyStep | None, cases: int) -> Iterator[str]:
    """Yield how many cases were repeated in regular steps, and the bias of each measure."""
    if survey is None:
        return
    begin = f"survey in steps of {survey.time_step}, which"
    if survey.repeated:
        repeated = f"these were repeated in steps of {survey.regular_step}"
        yield f"{begin} could not settle {survey.repeated} of {counted(cases, 'case')}: {repeated}"
    else:
        yield f"{begin} settled all of {counted(cases, 'case')}"
    if survey.unknown:
        yield f"bias of the survey step: not known of {', '.join(survey.unknown)}"
    noted = [each for each in survey.biases if each.bias >= _LEAST_NOTED]
    for each in noted:
        yield (
            f"bias of the survey step: {each.measure} at most {_percent(each.bias)} on average ({each.case}),"
            f" {_percent(each.of_single_stops)} in 95 % of single stops"
        )
    if others := len(survey.biases) - len(noted):
        below = _percent(_LEAST_NOTED)
        yield f"bias of the survey step: below {below} in {counted(others, 'other measure')} judged or mapped"


def _percent(share: float) -> str:
    number = share / PERCENT
    return f"{number:.2g} %" if number < 100.0 else f"{number:.0f} %"
