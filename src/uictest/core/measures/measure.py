"""What declares a measure: its value for a stop, its column in results, and the data of a record it needs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Any, Literal, NamedTuple

from uictest.core.measures.records import StopMeasures, WheelsetMeasures
from uictest.core.units import KINDS

Course = Literal["grows", "falls", "settles"]
"""What a value can do while the stop goes on: only grow, only fall, or no more once there is one."""

Better = Literal["smaller", "larger", "neither"]
"""Which value of a measure is the better one, of two stops under the same conditions."""

When = Literal["throughout", "ends", "end", "never"]
"""When channels must be known: throughout the stop; at the brake command and at its end; at its end; never,
as no record holds them."""

DefinitionValues = Mapping[str, float]
"""Definition of a criterion -> its SI value."""


Wheelsets = Iterable[WheelsetMeasures]
"""One record per wheelset, from the leading end; may be iterated more than once."""


class MeasureValue(NamedTuple):
    """SI values of a measure, one for the stop or one per wheelset, as far as the stop was observed.

    `unavailable_reason` says why there is no value; empty where there is one. `whatever_follows`: there will
    be none however the stop goes on. `open_reason` says what the end of the stop cut short, so that the
    values might have changed after it; empty where nothing was.
    """

    values: tuple[float, ...] = ()
    unavailable_reason: str = ""
    whatever_follows: bool = False
    open_reason: str = ""


Reader = Callable[[StopMeasures, Wheelsets, DefinitionValues], MeasureValue]


def one_value(number: float) -> MeasureValue:
    """Return the value of a measure of the stop."""
    return MeasureValue((float(number),))


def value_per_wheelset(numbers: Iterable[float]) -> MeasureValue:
    """Return the values of a measure of the wheelsets, from the leading end."""
    return MeasureValue(tuple(map(float, numbers)))


def unavailable(reason: str) -> MeasureValue:
    """Return that a measure has no value, and why."""
    return MeasureValue(unavailable_reason=reason)


def _of_the_field(*_: Any) -> Any:
    """Stand for reading the measure's field."""


class Overview(NamedTuple):
    """How tables of cases show a column, shares in per cent, of wheelsets the largest value.

    Args:
        heading: a line feed begins the unit; `{}` stands for the train speed above which slides count.
        digits: behind the decimal point.
        rank: in which a narrow terminal leaves it out.
        short: heading where it shows it; empty: the same.
        few_digits: where it shows it; None: as many.
        unlike: a column that it must differ from in some case to be shown; empty: it always is.

    """

    heading: str
    digits: int
    rank: int
    short: str = ""
    few_digits: int | None = None
    unlike: str = ""


@dataclass(frozen=True, slots=True)
class Column:
    """A number that results report of every stop, whatever its criteria.

    Args:
        name: key in results.json and name of the column in tables.
        unit: that it is reported in.
        meaning: what it is where it is not the value that a criterion bounds.
        whole: whether it is a count.
        overview: how tables of cases show it; None where they do not.

    """

    name: str
    unit: str
    meaning: str = ""
    whole: bool = False
    overview: Overview | None = None

    def text(self, value: float, digits: int) -> str:
        """Return a number in the unit of the column as tables of cases show it."""
        if self.whole:
            return f"{value:g}"
        return f"{100.0 * value if self.unit == '1' else value:.{digits}f}"


@dataclass(frozen=True, slots=True)
class StopColumn(Column):
    """A column of stops.

    `read` returns the number in SI units, NaN where there is none; left out, that of the measure's field.
    `defaults` holds the value of each definition that it uses for a stop none of whose criteria defines its
    own.
    """

    read: Callable[[StopMeasures, DefinitionValues], float] = field(kw_only=True, default=_of_the_field)
    defaults: DefinitionValues = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class WheelsetColumn(Column):
    """A column of wheelsets.

    `read` returns the number of one wheelset in SI units, NaN where there is none; left out, that of the
    measure's field.
    """

    read: Callable[[WheelsetMeasures], float] = field(kw_only=True, default=_of_the_field)


class RecordedData(NamedTuple):
    """The data that the record of a real stop must hold for a measure.

    Args:
        channels: that must be known; `{n}` stands for the number of the wheelset.
        when: they must be known.
        bounded: whether a part of the samples bounds the value, as that of a largest slide does.
        from_command: whether the brake command must be in the record.
        computed: whether a channel among them is computed rather than recorded: where a record lacks all of
            it, criteria of the measure do not apply instead of being inconclusive.

    """

    channels: tuple[str, ...]
    when: When = "throughout"
    bounded: bool = True
    from_command: bool = True
    computed: bool = False


How = Literal["intervals", "longest", "outer", "extreme", "span", "end"]
"""How a stop decides a measure: in the intervals in which a field of the records grows; in the longest of
them; from the first change of the field to the last; by its last change; over a span; at the end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ShownWhen:
    """When a stop decides a measure, and how its plots show that.

    Args:
        how: it does.
        plot: key of the panel or the strip that shows it.
        field: of the records of the wheelsets, else of that of the stop, whose changes decide. Every measure
            of the wheelsets names one: a recording is only fed to what these fields need.
        index: in the field, where that is a table.
        among: the wheelsets that count; None: all of them.
        channel: of the train that the extreme lies on, where the field is not drawn itself.
        span: first and last time, s, by the record of the whole stop; None: from its beginning to its end.
        down_to: definition that holds the train speed at which the span ends, and so do the bounds.
        level: whether the value is a height in the plot, as its bounds are.
        across: key of the plot along whose axis the value lies, as its bounds do; empty where there is none.
        along_distance: the value is a distance, not a time.
        word: before the value in its mark; at the end before the speed there, which takes its place.
        span_name: what the span is called where it is not the whole stop.

    """

    how: How
    plot: str
    field: str = ""
    index: Callable[[DefinitionValues], int] | None = None
    among: Callable[[WheelsetMeasures], bool] | None = None
    channel: str = ""
    span: Callable[[StopMeasures, DefinitionValues], tuple[float, float]] | None = None
    down_to: str = ""
    level: bool = False
    across: str = ""
    along_distance: bool = False
    word: str = ""
    span_name: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measure:
    """One measure of a stop, or of each wheelset in it, that a criterion can bound.

    Args:
        name: in criteria files.
        kind: of quantity that its bounds are, a key of :data:`uictest.core.units.KINDS`.
        unit: that a criterion prints value and bounds in; left out, the most usual of the kind.
        course: what the value can do while the stop goes on.
        better: which of two values says that a train brakes better, or is spared; `neither` for what
            describes the conditions or the simulation.
        meaning: what it is, in words.
        field: of the record of the stop, or of each wheelset, that holds its value; left out, that of its
            name.
        absent: why there is no value where no such field holds a number; empty where one always does.
        read: returns its value; left out, it is that of the field.
        decided: when a stop decides it; None for what no moment of a stop decides.
        of_wheelsets: whether every wheelset has a value.
        of_faults: whether it says something about the reaction to faults: nothing, where none began.
        of_braking: whether it is of how the train slows: nothing, where traction holds its speed.
        of_standstill: whether it is of a stop to standstill: nothing, where one ends above it.
        of_simulation: whether it says something about the simulation itself, nothing about a train.
        definitions: parameters that a criterion must define before the words mean a number.
        speed_range: says in words, by its definitions, at which train speeds it looks; None: at all of them.
        observed_by: fields of the scenario's `measures` part that decide what is observed.
        recorded: data of a record that it needs; None for one of a simulation.
        column: of results that needs the same data; None where results do not report it.
        corrected: which of `nominal_speed` and `gradient` of the stop its value is corrected for: `read` is
            given both beside the definitions.
        share_of: what a share is one of, behind its unit: `of the time`.
        approach: column of wheelsets that says, from 0 to 1, how near a stop comes to the first of what is
            measured, where a value of 0 does not: a lock begins at a slide of 1.
        finite_field: field of the record in which every simulated stop has a finite number; empty where NaN
            says that something never happened.

    """

    name: str
    kind: str
    unit: str = ""
    course: Course
    better: Better = "neither"
    meaning: str
    field: str = ""
    absent: str = ""
    read: Reader = _of_the_field
    decided: ShownWhen | None = None
    of_wheelsets: bool = False
    of_faults: bool = False
    of_braking: bool = False
    of_standstill: bool = False
    of_simulation: bool = False
    definitions: tuple[str, ...] = ()
    speed_range: Callable[[DefinitionValues], str] | None = None
    observed_by: tuple[str, ...] = ()
    recorded: RecordedData | None = None
    column: StopColumn | WheelsetColumn | None = None
    corrected: tuple[str, ...] = ()
    share_of: str = ""
    approach: str = ""
    finite_field: str = ""

    def __post_init__(self) -> None:
        """Set unit and field, and read the field where the measure, or its column, says nothing else."""
        object.__setattr__(self, "unit", self.unit or next(iter(KINDS[self.kind].units), "1"))
        object.__setattr__(self, "field", self.field or self.name)
        if self.read is _of_the_field:
            object.__setattr__(self, "read", self._read_field)
        if self.column is not None and self.column.read is _of_the_field:
            number: Any = attrgetter(self.field)
            of_stop = isinstance(self.column, StopColumn)
            read: Any = (lambda stop, definition: number(stop)) if of_stop else number
            object.__setattr__(self, "column", replace(self.column, read=read))

    def _read_field(self, stop: StopMeasures, wheelsets: Wheelsets, _: DefinitionValues) -> MeasureValue:
        records = wheelsets if self.of_wheelsets else [stop]
        value = value_per_wheelset(map(attrgetter(self.field), records))
        return unavailable(self.absent) if self.absent and all(map(math.isnan, value.values)) else value
