"""The same case in one run after the other: its verdicts, its distances, and what it was run with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from uictest import report
from uictest.runs.history.entry import CaseEntry
from uictest.runs.history.run_in_folder import ListedRun

_Key = tuple[bool, str]
"""Whether it is a series, and its id."""


@dataclass(frozen=True, slots=True)
class CaseHistory:
    """A case, or a series, in the runs that are shown.

    Args:
        id: of the case or series.
        runs: the runs, oldest first.
        entries: the case in each run; None where it was not run.
        places: places of the runs that have it, oldest first.

    """

    id: str
    runs: Sequence[ListedRun]
    entries: Sequence[CaseEntry | None]
    places: Sequence[int]

    def entry(self, place: int) -> CaseEntry:
        """Return the case in a run that has it."""
        entry = self.entries[place]
        assert entry is not None
        return entry

    @property
    def newest(self) -> CaseEntry:
        """The case in the newest run that has it."""
        return self.entry(self.places[-1])

    @property
    def change(self) -> float | None:
        """Distance less that of the run before that has the case, m; None without both."""
        if len(self.places) < 2:
            return None
        before, now = (self.entry(place).distance for place in self.places[-2:])
        return None if before is None or now is None else now - before

    @property
    def turned(self) -> bool:
        """Whether the verdict is not the same in all runs."""
        return len({self.entry(place).word for place in self.places}) > 1

    def changes(self) -> dict[int, list[str] | None]:
        """Return what changed in the inputs at each place but the first, see :func:`changed_inputs`."""
        return {
            now: changed_inputs(
                (self.runs[before], self.entry(before)),
                (self.runs[now], self.entry(now)),
            )
            for before, now in pairwise(self.places)
        }


def case_histories(runs: Sequence[ListedRun]) -> list[CaseHistory]:
    """Return the history of every case and series; `runs` are those that are shown, oldest first."""
    tables = [{(case.is_series, case.id): case for case in run.cases} for run in runs]
    keys = dict.fromkeys(key for table in reversed(tables) for key in table)
    return sorted((_history(each, runs, tables) for each in keys), key=_urgency)


def _history(key: _Key, runs: Sequence[ListedRun], tables: Sequence[Mapping[_Key, CaseEntry]]) -> CaseHistory:
    entries = [table.get(key) for table in tables]
    places = [place for place, entry in enumerate(entries) if entry is not None]
    return CaseHistory(key[1], runs, entries, places)


def runs_with_cases(runs: Sequence[ListedRun]) -> list[ListedRun]:
    """Return the runs of which the cases are known, oldest first; `runs` come newest first."""
    return [run for run in runs if run.cases][::-1]


def changed_inputs(before: tuple[ListedRun, CaseEntry], now: tuple[ListedRun, CaseEntry]) -> list[str] | None:
    """Return which parts of a case and which packages differ between two runs; None if that is not known.

    A part is named by its kind, such as `controller`; a package with both versions. `expect` is the outcome
    that is expected, `repeat` how often and by which rule the case repeats its stop.
    """
    (earlier, case_before), (later, case_now) = before, now
    if not (case_before.parts and case_now.parts):
        return None
    same = case_before.parts == case_now.parts
    parts = [] if same else _different(case_before.parts_by_kind, case_now.parts_by_kind)
    same = earlier.versions == later.versions
    packages = [] if same else _different(earlier.versions, later.versions)
    return [*parts, *(_version_change(name, earlier, later) for name in packages)]


def _version_change(package: str, earlier: ListedRun, later: ListedRun) -> str:
    before, now = (run.versions.get(package, "none") for run in (earlier, later))
    return f"{package} {before} → {now}"


def _different(before: Mapping[str, object], now: Mapping[str, object]) -> list[str]:
    return [key for key in dict.fromkeys((*before, *now)) if before.get(key) != now.get(key)]


def _urgency(history: CaseHistory) -> tuple[bool, bool, float, str]:
    """Return the key that sorts cases: not as expected first, then turned ones, then the largest change."""
    change, distance = history.change, history.newest.distance
    relative = abs(change) / distance if change is not None and distance else 0.0
    return report.tone(history.newest.word) == "good", not history.turned, -relative, history.id
