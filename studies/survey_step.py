"""What the survey step of sweeps, 1 ms instead of 0.5 ms, does to every measure of a stop.

`python studies/survey_step.py` runs every shipped case, some with the other built-in controller and one with
a fault in both steps, stop by stop with the same noise, and writes the mean of the differences with its 95 %
interval to the library, from where a sweep takes it. In most stops WSP cycling takes another course after a
while, so that only the mean of many says what the step does.
"""

import argparse
import csv
import sys
from collections import namedtuple
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from io import StringIO
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import MEASURES, STOP_COLUMNS, STOP_MEASURES, WHEELSET_MEASURES, Measure
from uictest.core.statistics import mean_interval
from uictest.core.units import in_unit
from uictest.plans import library
from uictest.plans.scenario import Case, corrections, load
from uictest.rig import assemble, run_in_lanes
from uictest.running.chunked import SURVEY_TABLE

ROOT: Final = Path(__file__).parents[1]
STOPS: Final = 512
"""Pairs of each case: the interval of the mean distance is then some 0.1 % wide where wheels slide."""
SEED: Final = 1
"""Noise key of the first pair; those of the others follow."""
COLUMNS: Final = ("case", "measure", "unit", "stops", "size", "mean", "low", "high", "of_single_stops")
CRITERIA: Final = ",".join(library.names("criteria"))

_tuple_of: Any = namedtuple
_Stop: Final = _tuple_of("_Stop", STOP_MEASURES.names)
_Wheelset: Final = _tuple_of("_Wheelset", WHEELSET_MEASURES.names)


@dataclass(frozen=True, slots=True)
class Variant:
    """A scenario, and what is set in it; `name` stands behind the id of its cases."""

    path: Path
    settings: Sequence[str] = ()
    name: str = ""


def variants() -> list[Variant]:
    """Return what is run."""
    scenarios = ROOT / "scenarios"
    shipped = [path for path in sorted(scenarios.glob("*.yaml")) if path.name.count(".") == 1]
    other = ("slip-120", "low-adhesion-80", "slide-80-four-caliper")
    return [
        *map(Variant, shipped),
        *(Variant(scenarios / f"{name}.yaml", ["controller=slip-band"], " with slip-band") for name in other),
        Variant(ROOT / "examples" / "faults" / "slip-120-with-fault.yaml"),
    ]


def cases_of(variant: Variant, step: str) -> list[Case]:
    """Return the cases of a variant in steps of this length, judged by all criteria of the library.

    Without those of trains: no sweep runs them, and nothing else takes survey steps.
    """
    settings = [f"simulation.time_step={step}", f"criteria=[{CRITERIA}]", *variant.settings]
    return [case for case in load([variant.path], settings) if case.train is None]


def stops_of(case: Case, count: int) -> Iterator[tuple[Any, list[Any]]]:
    """Yield the measures of stops of a case that differ in their noise, and those of their wheelsets."""
    inputs = assemble(case)
    many = np.repeat(inputs.parameters.reshape(1), count).view(inputs.parameters.dtype)
    many["noise_key"] = SEED + np.arange(count)
    stops, wheelsets = run_in_lanes(
        many, np.tile(inputs.wheelset_parameters, (count, 1)), np.tile(inputs.rail, (count, 1, 1))
    )
    for stop, of_stop in zip(stops.tolist(), wheelsets.tolist(), strict=True):
        yield _Stop(*stop), [_Wheelset(*each) for each in of_stop]


def definitions(case: Case) -> dict[str, Mapping[str, float]]:
    """Return what measures are taken to mean: as the first criterion of the library says that has one."""
    common = {name: value for each in STOP_COLUMNS.values() for name, value in each.defaults.items()}
    common |= {name: float(value) for name, value in corrections(case.scenario).items()}
    stated: dict[str, Mapping[str, float]] = {}
    for criterion in (each for profile in case.scenario.criteria for each in profile.criteria):
        read_as: tuple[Any, ...] = (criterion, *criterion.readings)
        for each in read_as:
            stated.setdefault(each.measure, each.definition.stated)
            common = {**each.definition.stated, **common}
    return {name: {**common, **stated.get(name, {})} for name in MEASURES}


def values(measure: Measure, definition: Mapping[str, float], stop: tuple[Any, list[Any]]) -> list[float]:
    """Return the values of a measure in its unit; NaN four times where there is none."""
    found = measure.read(*stop, definition)
    numbers = [float(in_unit(number, measure.unit)) for number in found.values]
    return numbers or [float("nan")] * 4


def rows_of(variant: Variant, count: int) -> Iterator[dict[str, str]]:
    """Yield a row for each case and measure that has values in both steps."""
    for regular, survey in zip(cases_of(variant, "0.5 ms"), cases_of(variant, "1 ms"), strict=True):
        pairs = list(zip(stops_of(regular, count), stops_of(survey, count), strict=True))
        meanings = definitions(regular)
        for name, measure in MEASURES.items():
            read = partial(values, measure, meanings[name])
            both = [_table([read(pair[place]) for pair in pairs]) for place in (0, 1)]
            known = [each for each in map(_compared, both[0].T, both[1].T) if each is not None]
            if known:
                texts = _texts(max(known, key=_bias))
                yield dict(
                    zip(
                        COLUMNS,
                        (f"{regular.id}{variant.name}", measure.name, measure.unit, *texts),
                        strict=True,
                    )
                )


def _table(readings: Sequence[Sequence[float]]) -> NDArray[np.float64]:
    """Return the values of a measure, shape (stops, values)."""
    width = min(map(len, readings))
    return np.array([each[:width] for each in readings])


def _compared(regular: NDArray[np.float64], survey: NDArray[np.float64]) -> list[float] | None:
    """Return number of stops, mean size, mean difference with its interval, difference of single stops.

    None where fewer than two stops have a value in both steps.
    """
    known = np.isfinite(regular) & np.isfinite(survey)
    if known.sum() < 2:
        return None
    differences = (survey - regular)[known]
    size = float(np.abs(np.concatenate([regular[known], survey[known]])).mean())
    low, high = mean_interval(differences.tolist())
    return [known.sum(), size, (low + high) / 2, low, high, float(np.quantile(np.abs(differences), 0.95))]


def _bias(compared: Sequence[float]) -> float:
    _, size, _, low, high, _ = compared
    return max(abs(low), abs(high)) / size if size else 0.0


def _texts(compared: Sequence[float]) -> list[str]:
    count, *numbers = compared
    return [str(count), *(f"{number:.4g}" for number in numbers)]


def table(chosen: Sequence[Variant], count: int) -> str:
    """Return the table as CSV."""
    text = StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for variant in chosen:
        writer.writerows(rows_of(variant, count))
    return text.getvalue()


def main() -> int:
    """Write the table, or with `--check` say whether the library's is this one."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--check", action="store_true", help="only say whether the library's is the same")
    given = parser.parse_args()
    found = table(variants(), STOPS)
    if given.check:
        same = found == library.table(SURVEY_TABLE)
        print("the same table" if same else "another table")
        return 0 if same else 1
    Path(library.__file__).with_name(SURVEY_TABLE).write_text(found, "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
