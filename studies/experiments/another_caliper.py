"""Compensations identified on a module that their structure does not contain, judged on stops of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from statistics import median
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from studies.drawing import BAND, INK, SETTING_COLOURS, WIDTH, title_and_legend
from studies.hardware.bench import recorded
from studies.hardware.judged import bench_records, judged_cases, judged_replay, only_inputs, owners_case
from studies.hardware.parameters import HARDWARE, WITHOUT, Hardware
from studies.identified_module import (
    BOUND,
    Fits,
    WayErrors,
    air_of,
    errors,
    identified,
    pressure_errors,
    shipped,
)
from studies.quantity import NOT_ASKED, SourceBand, Status, StudyQuantity, StudyValue
from studies.replay import VENT
from studies.stop_runner import StopRunner, constant_friction
from studies.study import Study, StudyFindings, Table
from uictest import Case, Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _without(*names: str) -> dict[str, float]:
    """Return the numbers of a module that lacks these differences."""
    return {key: value for name in names for key, value in WITHOUT[name].items()}


_PRESSURE, _FORCE = "% of maximum pressure", "% of largest force"
_TITLES: Final = {
    "nothing": "tank 2 as it is",
    "full": "full",
    "thermal": "thermal",
    "thermal_largest": "thermal for the largest error",
    "shipped": "thermal as it ships",
}
_STATISTICS: Final[Mapping[str, Callable[[Sequence[float]], float]]] = {"median": median, "worst": max}
_FORCE_WAYS: Final = ("full", "thermal", "thermal_largest", "shipped")
_COMPENSATIONS: Final = ("full", "thermal", "thermal_largest")
_MODULES: Final = {
    **{f"without_{name}": changes for name, changes in WITHOUT.items()},
    "without_any": _without(*WITHOUT),
    **{f"only_{name}": _without(*(other for other in WITHOUT if other != name)) for name in WITHOUT},
    # Fewer balls make up for its smaller volume.
    "other_hose": {"hose_bore": 0.013, "hose_length": 1.0, "ball_volume": 0.246e-3},
}
"""Module -> what differs in it from the declared one. The last five came after the first judgement."""
_MODULE_TITLES: Final = {
    **{name: f"without its {name.removeprefix('without_')}" for name in _MODULES},
    "without_any": "without all four differences",
    **{f"only_{name}": f"with no difference but its {name}" for name in WITHOUT},
    "other_hose": "with a hose of 13 mm and 1 m",
}
_WIDE: Final = {"mean": "identified", "largest": "for the largest error", "shipped": "as it ships"}
_WIDE_CLEARANCE: Final = "6 mm"
_HOSE_MISSES: Final = (
    "No compensation knows that the air in a hose has resistance and inertia: where a released cylinder is "
    "filled quickly, the piston closes the clearance within hundredths of a second, and the pressure behind "
    "the hose stays some tenths of a bar below that of the tank."
)
_FILTER_MISSES: Final = f"{_HOSE_MISSES} A linear filter follows the heat only in part as well."
_MISSES: Final = {
    **{f"{kind}_{each}_full": _FILTER_MISSES for kind in ("pressure", "force") for each in _STATISTICS},
    **{f"{kind}_{each}_thermal": _HOSE_MISSES for kind in ("pressure", "force") for each in _STATISTICS},
    **{f"pressure_{each}_thermal_largest": _HOSE_MISSES for each in _STATISTICS},
    "force_worst_thermal_largest": _HOSE_MISSES,
}
"""Declared after the first judgement; no band was changed."""
_TRAINING_SEED, _JUDGED_SEED = 71, 100
"""Seeds of the noise of the module's sensors; that of a judged stop counts from the second."""


def _bounded(upper: float, below: bool) -> SourceBand:
    """Return the paper's bound, which it states for its own compensation, asked here of every one."""
    return SourceBand(upper=upper, below=below, reason="paper, of its own compensation")


def _quantities() -> Iterator[StudyQuantity]:
    yield _shown("bench_hysteresis", "force error by its own pressure, bench", _FORCE, "calibrated")
    for way in _COMPENSATIONS:
        yield _shown(f"bench_{way}", f"pressure error, {_TITLES[way]}, bench", _PRESSURE, "calibrated")
    for kind, ways, unit, band in (
        ("pressure", tuple(_TITLES), _PRESSURE, _bounded(BOUND, below=True)),
        ("force", _FORCE_WAYS, _FORCE, _bounded(8.0, below=False)),
    ):
        for way, statistic in product(ways, _STATISTICS):
            yield StudyQuantity(
                key := f"{kind}_{statistic}_{way}",
                f"{kind} error, {_TITLES[way]}, {statistic}",
                unit,
                "below 2 %" if kind == "pressure" else "within +-8 %",
                status="predicted",
                band=replace(band, declared_miss=_MISSES.get(key, "")) if way in _COMPENSATIONS else None,
                digits=2,
            )
    for way, statistic in product(_COMPENSATIONS, _STATISTICS):
        title = f"time with {BOUND:g} % of pressure error or more, {_TITLES[way]}, {statistic}"
        yield _shown(f"beyond_{statistic}_{way}", title, "% of the stop")
    for name, statistic in product(_MODULES, _STATISTICS):
        title = f"pressure error, thermal, module {_MODULE_TITLES[name]}, {statistic}"
        yield _shown(f"{name}_{statistic}", title, _PRESSURE)
    for name, statistic in product(_WIDE, _STATISTICS):
        title = (
            f"pressure error, thermal {_WIDE[name]}, library's caliper with {_WIDE_CLEARANCE}, {statistic}"
        )
        yield _shown(f"wide_{name}_{statistic}", title, _PRESSURE)


def _shown(key: str, title: str, unit: str, status: Status = "predicted") -> StudyQuantity:
    return StudyQuantity(key, title, unit, NOT_ASKED, status=status, digits=2)


@dataclass(frozen=True, slots=True)
class _Judged:
    """The errors of every way in one judged stop; `vents`: how often its valve vents."""

    case: Case
    vents: int
    errors: Mapping[str, WayErrors]


def run(stop_runner: StopRunner) -> StudyFindings:
    """Identify on the bench of the second module, judge on its stops, and take its differences away."""
    owner = owners_case()
    training = {name: only_inputs(record) for name, record in bench_records().items()}
    cases = judged_cases(stop_runner)
    inputs = stop_runner.map(_inputs, cases)
    records = {name: recorded(record, _TRAINING_SEED) for name, record in training.items()}
    fits = identified(records["hysteresis"], records["pressure"], owner)
    others = shipped(owner.scenario.rig.compensation_model)

    def judge(k: int) -> _Judged:
        (driving, top), vents = inputs[k], 0
        record = recorded(driving, _JUDGED_SEED + k)
        vents = int(np.count_nonzero(np.diff((record["valve_command_1"] == VENT).astype(int)) > 0))
        found = errors(record, fits, owner, top)
        return _Judged(cases[k], vents, {**found, "shipped": errors(record, others, owner, top)["thermal"]})

    judged = stop_runner.map(judge, range(len(cases)))
    shown = {
        name: _on_module(stop_runner, HARDWARE._replace(**changes), training, inputs, owner)
        for name, changes in _MODULES.items()
    }
    shown |= _wide_clearance(stop_runner)
    return StudyFindings(
        dict(_values(fits, judged, shown)),
        tables={"judged": _table(judged)},
        drawings={"another-caliper": partial(draw, judged)},
        notes=(
            f"{len(judged)} stops, declared with the module before anything was identified on it.",
            *(f"Refused, {subject}: {reason}." for subject, reason in fits.refusals.items()),
            *(_worst_note(judged, way) for way in _COMPENSATIONS if way not in fits.refusals),
        ),
    )


def _inputs(case: Case) -> tuple[Recording, float]:
    """Return what drives a module in a judged stop, and the pressure of the brake's position, Pa."""
    record, top = judged_replay(case)
    return only_inputs(record), top


def _on_module(
    stop_runner: StopRunner,
    module: Hardware,
    training: Mapping[str, Recording],
    inputs: Sequence[tuple[Recording, float]],
    owner: Case,
) -> list[float]:
    """Return the largest error of `thermal` in every judged stop, identified and judged on another module."""
    air = air_of(recorded(training["pressure"], _TRAINING_SEED, module), owner)

    def error(k: int) -> float:
        driving, top = inputs[k]
        return pressure_errors(recorded(driving, _JUDGED_SEED + k, module), [air], owner, top)[0]

    return stop_runner.map(error, range(len(inputs)))


def _wide_clearance(stop_runner: StopRunner) -> dict[str, list[float]]:
    """Return the largest errors of `thermal` in every judged stop on the library's caliper, more open."""
    changes = {"rig.caliper.clearance": _WIDE_CLEARANCE}
    record = bench_records([f"{key}={value}" for key, value in changes.items()])["pressure"]
    cases = judged_cases(stop_runner, changes)
    mean = air_of(record, cases[0])
    ships = cases[0].scenario.rig.compensation_model.air
    airs = [mean, mean and air_of(record, cases[0], mean), ships]

    def found(case: Case) -> list[float]:
        replay, top = judged_replay(case)
        return pressure_errors(replay, airs, case, top)

    of_airs = zip(*stop_runner.map(found, cases), strict=True)
    return {f"wide_{name}": list(each) for name, each in zip(_WIDE, of_airs, strict=True)}


def _values(
    fits: Fits, judged: Sequence[_Judged], shown: Mapping[str, Sequence[float]]
) -> Iterator[tuple[str, StudyValue]]:
    for subject, error in fits.training.items():
        yield f"bench_{subject}", StudyValue(error)
    found = {f"pressure_{{}}_{way}": [each.errors[way].pressure_error for each in judged] for way in _TITLES}
    found |= {f"force_{{}}_{way}": [each.errors[way].force_error for each in judged] for way in _FORCE_WAYS}
    found |= {f"beyond_{{}}_{way}": [each.errors[way].beyond for each in judged] for way in _COMPENSATIONS}
    found |= {f"{name}_{{}}": list(each) for name, each in shown.items()}
    for key, errors_of_stops in found.items():
        for statistic, reduce in _STATISTICS.items():
            missing = any(error != error for error in errors_of_stops)
            value = float("nan") if missing else float(reduce(errors_of_stops))
            yield key.format(statistic), StudyValue(value)


def _table(judged: Sequence[_Judged]) -> Table:
    """Return a row for every judged stop, the largest errors of `thermal` first."""
    rows = sorted(judged, key=lambda each: -each.errors["thermal"].pressure_error)
    columns: dict[str, list[Any]] = {
        "friction": [constant_friction(each.case) for each in rows],
        "initial_speed": [each.case.scenario.initial_speed.text for each in rows],
        "command": [each.case.scenario.brake.first_command.text for each in rows],
        "controller": [each.case.scenario.controller.name for each in rows],
        "vents": [each.vents for each in rows],
    }
    for way in _TITLES:
        columns[f"{way}_pressure_percent"] = [round(each.errors[way].pressure_error, 3) for each in rows]
        true = [round(each.errors[way].true_pressure_error, 3) for each in rows]
        columns[f"{way}_true_pressure_percent"] = true
        columns[f"{way}_beyond_percent"] = [round(each.errors[way].beyond, 3) for each in rows]
        columns[f"{way}_force_percent"] = [round(each.errors[way].force_error, 3) for each in rows]
    return columns


def _worst_note(judged: Sequence[_Judged], way: str) -> str:
    """Return where a compensation errs most, and in how many stops its pressure leaves the bound."""
    worst = max(judged, key=lambda each: each.errors[way].pressure_error)
    missed = sum(each.errors[way].pressure_error >= BOUND for each in judged)
    scenario = worst.case.scenario
    place = f"friction {constant_friction(worst.case):g} from {scenario.initial_speed.text}"
    return (
        f"{_TITLES[way]}: pressure misses {BOUND:g} % in {missed} of {len(judged)} stops, worst at {place},"
        f" {scenario.brake.first_command.text} command, {scenario.controller.name}."
    )


_COLOURS: Final = {
    "nothing": (SETTING_COLOURS["none"], "-"),
    "full": (SETTING_COLOURS["full"], "--"),
    "thermal": (SETTING_COLOURS["thermal"], "-"),
    "thermal_largest": (INK, "-"),
}


def draw(judged: Sequence[_Judged], figure: Figure) -> None:
    """Draw the largest errors of pressure of all judged stops in order of size, and the bound on them."""
    figure.set_size_inches(WIDTH, 3.2)
    axes = figure.subplots()
    axes.axhspan(0.0, BOUND, color=BAND, zorder=0)
    for way, (colour, dashes) in _COLOURS.items():
        values = sorted(each.errors[way].pressure_error for each in judged)
        axes.plot(range(1, len(values) + 1), values, dashes, color=colour, label=_TITLES[way])
    axes.set(xlabel="stops, in order of their error", ylabel="% of maximum pressure", ylim=(0.0, None))
    title_and_legend(axes, "Largest error of pressure on a module outside the structure", 4)


STUDY = Study(
    "another-caliper",
    "Compensations on a module whose hose, orifice, travel and leak they do not know",
    "",
    tuple(_quantities()),
    run,
    position=118,
)
