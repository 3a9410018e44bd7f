"""What a sweep is asked for besides its cases: maps, measures, a frontier."""

from __future__ import annotations

from collections.abc import Sequence

from uictest.analysis import summaries
from uictest.plans import sweeps
from uictest.plans.scenario import yaml
from uictest.running import chunked


class ToleranceError(ValueError):
    """A tolerance of a frontier that is no number with a unit."""


def first_pair(plan: sweeps.Plan) -> tuple[str, str] | None:
    """Return the first two parameters with several listed values, None without two of them."""
    listed = [key for key, values in plan.listed().items() if len(values) > 1]
    return (listed[0], listed[1]) if len(listed) > 1 else None


def measure_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return columns of measures, else the braking distance. Raises ValueError for another name."""
    columns = chunked.measure_columns()
    for name in names or ():
        if name not in columns:
            raise ValueError(f"no measure {name!r}; {yaml.suggestion(name, columns)}")
    return tuple(dict.fromkeys(names or ("braking_distance_m",)))


def frontier_search(
    plan: sweeps.Plan, key: str | None, tolerance: str | None
) -> summaries.FrontierSearch | None:
    """Return the search of a frontier along a parameter.

    Raises FrontierError for the parameter, ToleranceError for the tolerance.
    """
    if key is None:
        return None
    try:
        width = None if tolerance is None else sweeps.parse_decimal_quantity(tolerance)
        return summaries.FrontierSearch(plan, key, width)
    except summaries.FrontierError:
        raise
    except ValueError as error:
        raise ToleranceError(str(error)) from error
