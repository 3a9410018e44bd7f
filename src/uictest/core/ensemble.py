"""Numbers of several cases at once, on which code that is written for one case runs unchanged.

Arithmetic on an :class:`Ensemble` is that of Python's floats, element by element, with the same bits. Where a
condition holds in some of the cases only, the cases part: :func:`by_way` runs the code again for each part.
Code that asks for the number of one case, to print it or to round it, is run case by case: all of it, or
only the function that does so (:func:`case_by_case`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.int64]
"""Places of cases in a block, from 0."""
Result = TypeVar("Result")


def rows_at(rows: NDArray[Any], places: Places) -> NDArray[Any]:
    """Return the rows at some places; all of them without a copy."""
    return rows if np.array_equal(places, np.arange(len(rows))) else rows[places]


def alike(columns: Iterable[NDArray[Any]], count: int) -> list[Places]:
    """Return the places of cases that have the same number in every column; numbers are not negative."""
    parting = [column for column in columns if (column != column[:1]).any()]
    if not parting:
        return [np.arange(count)]
    group_of = np.zeros(count, np.int64)
    for column in parting:
        _, group_of = np.unique(group_of * (int(column.max()) + 1) + column, return_inverse=True)
    order, sizes = np.argsort(group_of, kind="stable"), np.bincount(group_of)
    return np.split(order, np.cumsum(sizes)[:-1])


class DivergingCasesError(Exception):
    """A condition holds in some of the cases only: in those where `holds` is true."""

    def __init__(self, holds: NDArray[np.bool_]) -> None:
        super().__init__("a condition holds in some of the cases only")
        self.holds = holds


class SingleCaseError(Exception):
    """The number of one case is asked for."""


class Ensemble(np.ndarray[Any, Any]):
    """A number of each of n cases, shape (n,); or a table, shape (length, n)."""

    def __bool__(self) -> bool:
        holds = np.asarray(self, bool)
        if holds.all():
            return True
        if holds.any():
            raise DivergingCasesError(holds)
        return False

    # As Python does, `float_power` asks the C library; `**` of numpy may differ from it in the last bit.
    def __pow__(self, exponent: float) -> Ensemble:  # type: ignore[override]
        return ensemble(np.float_power(self, exponent))

    def __round__(self) -> Ensemble:
        return ensemble(np.rint(self))

    def _refuse(self, *arguments: Any) -> Any:
        raise SingleCaseError

    __float__ = __int__ = __index__ = __rpow__ = __str__ = __format__ = _refuse


def ensemble(numbers: NDArray[Any]) -> Ensemble:
    """Return numbers of cases as an ensemble, without a copy."""
    return numbers.view(Ensemble)


def case_by_case(function: Callable[..., tuple[float, ...]], *numbers: Any) -> tuple[Any, ...]:
    """Return what a function gives for the plain numbers of one case; of several, for each of them alone."""
    if not any(isinstance(number, Ensemble) for number in numbers):
        return function(*map(float, numbers))
    columns = np.broadcast_arrays(*(np.asarray(number, float) for number in numbers))
    results = [function(*of_case) for of_case in zip(*(column.tolist() for column in columns), strict=True)]
    return tuple(ensemble(np.array(column)) for column in zip(*results, strict=True))


def by_way(
    together: Callable[[Places], Result], alone: Callable[[int], Result], places: Places
) -> Iterator[tuple[Places, Result]]:
    """Yield the results of a function for groups of cases that take the same way through it.

    Args:
        together: the function for the cases at some places, with ensembles for what differs.
        alone: the function for the case at one place.
        places: of all cases.

    Raises whatever `alone` raises.

    """
    if places.size == 0:
        return
    if places.size == 1:
        yield places, alone(int(places[0]))
        return
    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            result = together(places)
    except DivergingCasesError as parting:
        for part in (places[parting.holds], places[~parting.holds]):
            yield from by_way(together, alone, part)
    except Exception:  # whatever cannot be had together is looked for case by case, where it raises again
        for place in places:
            yield np.array([place]), alone(int(place))
    else:
        yield places, result
