"""The same case in one run after the other, as data and as a small drawing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Final, Literal, NamedTuple

from uictest import report
from uictest.runs.history.entry import CaseEntry
from uictest.runs.history.run_in_folder import ListedRun

_Key = tuple[bool, str]
"""Whether it is a series, and its id."""


class CaseHistory(NamedTuple):
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
        """Whether the verdict of the newest run that has the case is not that of the run before it."""
        return len({self.entry(place).word for place in self.places[-2:]}) > 1

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


_NARROWEST, _WIDEST, _WIDTH = 9, 16, 360
"""Of a run, and of all runs as far as they fit, pixels."""
_MARKS: Final = 6.0
_TOP, _BOTTOM = 17.0, 35.0
HEIGHT: Final = 39
_LEAST_RANGE: Final = 0.01
"""Range that fills the height, over the distance, at least: a smaller one would look like a large change."""

Shape = Literal["good", "skipped", "bad", "odd"]
"""A disc, a ring, a cross, a triangle: told apart without colours."""

_SHAPES: Final[dict[Shape, str]] = {
    "good": "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
    "skipped": "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
    "bad": "m-3-3l6 6m0-6l-6 6",
    "odd": "m0-3.6l3.8 6.8h-7.6z",
}


class Strip(NamedTuple):
    """What is drawn of a case, in pixels.

    Args:
        marks: path of the marks by their shape.
        line: path through the distances; empty where less than two runs have one.
        changes: path of the ticks where inputs changed.
        newest: place of the newest distance; None without one.

    """

    marks: dict[Shape, str]
    line: str
    changes: str
    newest: tuple[float, float] | None


def strip(history: CaseHistory) -> Strip:
    """Return the drawing of a case."""
    points = _points(history)
    changed = [place for place, names in history.changes().items() if names]
    return Strip(
        _marks(history),
        "".join(f"{'L' if n else 'M'}{x:g} {y:g}" for n, (x, y) in enumerate(points)) if points[1:] else "",
        "".join(f"M{place * slot_width(len(history.runs))} 13V{HEIGHT}" for place in changed),
        points[-1] if points else None,
    )


def width(runs: int) -> int:
    """Return the width of a drawing with so many runs, pixels."""
    return slot_width(runs) * runs


def slot_width(runs: int) -> int:
    """Return the width of one of so many runs, pixels."""
    return min(max(_WIDTH // runs, _NARROWEST), _WIDEST) if runs else _WIDEST


def shape(word: str) -> Shape:
    """Return the shape of a word of `report.CASE_WORDS`."""
    return "skipped" if word == "skipped" else report.tone(word)


def summary(history: CaseHistory) -> str:
    """Return what the drawing shows, in words."""
    words = [history.entry(place).word for place in history.places]
    turns = sum(before != now for before, now in pairwise(words))
    counts = ", ".join(f"{words.count(word)} {word}" for word in report.CASE_WORDS if word in words)
    turned = f"; the verdict turned {report.counted(turns, 'time')}" if turns else ""
    return f"{report.counted(len(words), 'run')}: {counts}{turned}{_range_words(history)}"


def distances(history: CaseHistory) -> list[tuple[int, float]]:
    """Return the place of every run that has a distance, and the distance, m."""
    entries = ((place, history.entry(place).distance) for place in history.places)
    return [(place, distance) for place, distance in entries if distance is not None]


def _middle(history: CaseHistory, place: int) -> float:
    return slot_width(len(history.runs)) * (place + 0.5)


def _range_words(history: CaseHistory) -> str:
    values = [distance for _, distance in distances(history)]
    return f"; distance {min(values):.1f} .. {max(values):.1f} m" if values else ""


def _marks(history: CaseHistory) -> dict[Shape, str]:
    paths: dict[Shape, str] = {}
    for place in history.places:
        kind = shape(history.entry(place).word)
        paths[kind] = f"{paths.get(kind, '')}M{_middle(history, place):g} {_MARKS:g}{_SHAPES[kind]}"
    return paths


def _points(history: CaseHistory) -> list[tuple[float, float]]:
    """Return the distances in pixels: their range fills the height, if it is not too small."""
    found = distances(history)
    values: Sequence[float] = [distance for _, distance in found]
    low, high = (min(values), max(values)) if values else (0.0, 0.0)
    span = max(high - low, _LEAST_RANGE * abs(high)) or 1.0
    lowest = (low + high - span) / 2.0
    shares = [(value - lowest) / span for value in values]
    return [
        (_middle(history, place), round(_BOTTOM - (_BOTTOM - _TOP) * share, 1))
        for (place, _), share in zip(found, shares, strict=True)
    ]
