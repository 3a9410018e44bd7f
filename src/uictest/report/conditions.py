"""The conditions that some cases of a sweep share, in words: `friction 0.06 and 0.08 at command 100`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from uictest.judging.evaluation import CaseResult
from uictest.plans.scenario import short_keys
from uictest.report.words import counted, listed, printable

_MOST_CLAUSES: Final = 3
"""Parts that a description may have; of more a reader makes nothing. Chosen."""
_MOST_VALUES: Final = 4
"""Values of a parameter that are named one by one, before `0.05 to 0.15`; chosen."""

Values = dict[str, list[str]]
"""Swept key -> its values, in the order of the cases; `_NONE` of cases without the key."""
_NONE: Final = "none"


def shared_conditions(cases: Sequence[CaseResult], all_cases: Iterable[CaseResult]) -> str:
    """Return what the cases have in common and no other case of their scenarios has.

    Args:
        cases: of any scenarios.
        all_cases: every case of the run, these included.

    """
    by_scenario: dict[str, list[CaseResult]] = {}
    for case in all_cases:
        by_scenario.setdefault(_name(case), []).append(case)
    chosen: dict[str, list[CaseResult]] = {}
    for case in cases:
        chosen.setdefault(_name(case), []).append(case)
    if len(by_scenario) == 1:
        (peers,) = by_scenario.values()
        return _conditions(cases, peers) or "all cases"
    texts = []
    for name, members in chosen.items():
        where = _conditions(members, by_scenario[name])
        texts.append(f"{name} at {where}" if where else name)
    return "; ".join(texts) if len(texts) <= _MOST_CLAUSES else listed(list(chosen))


def _name(case: CaseResult) -> str:
    """Return the name of the scenario of a case: its id before the values of the sweep."""
    return printable(case.id.partition("[")[0])


def _conditions(cases: Sequence[CaseResult], peers: Sequence[CaseResult]) -> str:
    """Return the conditions of some cases of one scenario; empty where they are all there are."""
    if len(cases) == len(peers):
        return ""
    values = _varied(peers)
    names = short_keys(list(values))
    if text := _product(cases, peers, values, names):
        return text
    ids = {case.id for case in cases}
    if text := _product([peer for peer in peers if peer.id not in ids], peers, values, names):
        return f"all but {text}"
    for key in values:
        if text := _clauses(key, cases, peers, values, names):
            return text
    return f"{len(cases)} of {counted(len(peers), 'case')}"


def _varied(peers: Iterable[CaseResult]) -> Values:
    peers = list(peers)
    keys = dict.fromkeys(key for peer in peers for key in peer.parameters)
    values = {key: list(dict.fromkeys(_value(peer, key) for peer in peers)) for key in keys}
    return {key: texts for key, texts in values.items() if len(texts) > 1}


def _value(case: CaseResult, key: str) -> str:
    return case.parameters.get(key, _NONE)


def _product(
    cases: Sequence[CaseResult], peers: Iterable[CaseResult], values: Values, names: Mapping[str, str]
) -> str:
    """Return the values that the cases have, if no other case has one of them for each key; else nothing."""
    had = {key: {_value(case, key) for case in cases} for key in values}
    alike = [peer for peer in peers if all(_value(peer, key) in had[key] for key in values)]
    if len(alike) != len(cases):
        return ""
    named = [
        f"without {names[key]}"
        if had[key] == {_NONE}
        else f"{names[key]} {_values_text([text for text in values[key] if text in had[key]], values[key])}"
        for key in values
        if len(had[key]) < len(values[key])
    ]
    return printable(" at ".join(named))


def _clauses(
    key: str,
    cases: Sequence[CaseResult],
    peers: Sequence[CaseResult],
    values: Values,
    names: Mapping[str, str],
) -> str:
    """Return the conditions for each value of one key, values with the same conditions together."""
    alike: dict[frozenset[tuple[str, ...]], list[str]] = {}
    others = [other for other in values if other != key]
    for value in values[key]:
        at_value = [case for case in cases if _value(case, key) == value]
        if at_value:
            pattern = frozenset(tuple(_value(case, other) for other in others) for case in at_value)
            alike.setdefault(pattern, []).append(value)
    if len(alike) > _MOST_CLAUSES:
        return ""
    clauses = [
        _product([case for case in cases if _value(case, key) in shared], peers, values, names)
        for shared in alike.values()
    ]
    return "; ".join(clauses) if all(clauses) else ""


def _values_text(texts: Sequence[str], every: Sequence[str]) -> str:
    """Return values as people list them; those that follow each other as `first to last`."""
    first = every.index(texts[0])
    if len(texts) > _MOST_VALUES and list(every[first : first + len(texts)]) == list(texts):
        return f"{texts[0]} to {texts[-1]}"
    *some, last = texts
    return f"{', '.join(some)} and {last}" if some else last
