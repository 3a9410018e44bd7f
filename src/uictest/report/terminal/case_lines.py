"""One line per case, made for grep: the word of the case first, then the case id, then `key=value` pairs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from uictest.judging import evaluation
from uictest.report.baseline import BaselineComparison, case_explanation, case_word, difference_sentences
from uictest.report.difference import Difference
from uictest.report.escaping import printable
from uictest.report.part_wording import part_sentences, slide_speed
from uictest.report.repeat_wording import range_cells, share_cells
from uictest.report.wording import (
    DIFFERS,
    criterion_sentences,
    definition_sentence,
    line_word,
    listed,
    number,
    reading_sources,
    without_rig_that_holds,
)

SHOWN_MEASURES = ("braking_distance_m", "braking_time_s", "mean_deceleration_mps2", "initial_adhesion_g")

MOST_DIFFERENCES: Final = 3
"""Quantities out of the tolerance of a baseline that a case shows on a terminal; results.json has all."""


def case_line(result: evaluation.CaseResult, differences: Sequence[Difference] = ()) -> str:
    """Return the line of one case, ending with the reason if it is not met or differs from the baseline."""
    words = [line_word(case_word(result, differences)), printable(result.id)]
    words += [f"outcome={result.outcome}", f"expect={result.expect}", *_stops(result), *_measures(result)]
    if differences or not result.met:
        outcomes, *reasons = case_explanation(result, differences, MOST_DIFFERENCES)
        words.append(f"reason={'; '.join(reasons or [outcomes])}")
    return " ".join(words)


def missing_lines(baseline: BaselineComparison) -> Iterator[str]:
    """Yield one line per case of the baseline that is missing, and per series that differs from it."""
    for own_id in baseline.beside_cases:
        reason = "; ".join(difference_sentences(baseline.differences[own_id], MOST_DIFFERENCES))
        yield f"{DIFFERS} {printable(own_id)} reason={reason}"


def criterion_lines(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield one line per criterion of a case, each beginning with the case id."""
    for sentence in criterion_sentences(result):
        yield f"criterion {printable(result.id)} {sentence}"


def definition_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the definitions of each criterion, once for all cases in which they are the same."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for verdict in without_rig_that_holds(result.criteria):
            cases.setdefault((verdict.id, definition_sentence(verdict)), []).append(result.id)
            for reading, sentence in reading_sources(verdict).items():
                cases.setdefault((f"{verdict.id} read as {reading}", sentence), []).append(result.id)
    meanings = [criterion for criterion, _ in cases]
    for (criterion, sentence), names in cases.items():
        where = f" (in {listed(names)})" if meanings.count(criterion) > 1 else ""
        if sentence:
            yield f"definition {printable(criterion)}{where}: {sentence}"


def part_lines(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield the parts that cases were run with and their changes, once for all cases with the same part."""
    cases: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for role, sentence in part_sentences(result.parts, result.controller_version).items():
            cases.setdefault((role, sentence), []).append(result.id)
    for (role, sentence), names in cases.items():
        where = "" if len(names) == len(results) else f" (in {listed(names)})"
        yield f"part {role}{where}: {sentence}"


def _stops(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield how many stops of a repeated case passed, and the range of what `_measures` gives medians of."""
    for name, value in share_cells(result).items():
        yield f"{name}={value:.4g}"
    for name, value in range_cells(result, SHOWN_MEASURES[:1]).items():
        yield f"{name}={value:.5g}"


def _measures(result: evaluation.CaseResult) -> Iterator[str]:
    for name in SHOWN_MEASURES:
        if result.measures is not None:
            yield f"{name}={number(result.measures[name])}"
    if result.wheelsets:
        yield f"slide_above={slide_speed([result]).replace(' ', '')}"
        yield "maximum_slide=" + "/".join(number(wheelset["maximum_slide"]) for wheelset in result.wheelsets)
        vents = (number(wheelset["valve_actuations"]) for wheelset in result.wheelsets)
        yield "valve_actuations=" + "/".join(vents)
    if (times := result.response_times) is not None:
        yield f"missed_deadlines={times.missed_deadlines}"
        yield f"longest_answer_s={number(times.longest_answer_s)}"
        yield f"start_jitter_s={number(times.start_jitter_s)}"
