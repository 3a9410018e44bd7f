"""Compensations identified on a module that their structure does not contain, judged on stops of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from statistics import median
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from studies.drawing import BAND, INK, SETTING_COLOURS, WIDTH, title_and_legend
from studies.hardware.bench import recorded
from studies.hardware.judged import bench_records, judged_cases, judged_replay, only_inputs, owners_case
from studies.hardware.parameters import HARDWARE, WITHOUT, Hardware
from studies.identified_module import Fits, air_of, errors, identified, pressure_errors, shipped
from studies.model_errors import SettingErrors
from studies.quantity import NOT_ASKED, SourceBand, StudyQuantity, StudyValue
from studies.replay import VENT
from studies.stop_runner import StopRunner, constant_friction
from studies.study import Study, StudyFindings, Table
from uictest import Case, Recording

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PRESSURE, _FORCE = "% of maximum pressure", "% of largest force"
_TITLES: Final = {
    "nothing": "tank 2 as it is",
    "full": "full, identified",
    "thermal": "thermal, identified",
    "thermal_largest": "thermal, identified for the largest error",
    "shipped": "thermal as it ships, of another caliper",
}
_BOUND: Final = 2.0
"""The paper's bound on the error of pressure, %."""
_STATISTICS: Final[Mapping[str, Callable[[Sequence[float]], float]]] = {"median": median, "worst": max}
_FORCE_WAYS: Final = ("full", "thermal", "thermal_largest", "shipped")
_COMPENSATIONS: Final = ("full", "thermal", "thermal_largest")
_ABLATIONS: Final = {
    **{name: {**changes} for name, changes in WITHOUT.items()},
    "any": {key: value for changes in WITHOUT.values() for key, value in changes.items()},
}
"""What is taken away of the module -> its changed numbers."""
_WIDE: Final = {
    "mean": "identified",
    "largest": "identified for the largest error",
    "shipped": "as it ships, for 2.9 mm",
}
_WIDE_CLEARANCE: Final = "6 mm"
_TRAINING_SEED, _JUDGED_SEED = 71, 100
"""Seeds of the noise of the module's sensors; that of a judged stop counts from the second."""


def _bounded(upper: float, below: bool) -> SourceBand:
    """Return the paper's bound, which it states for its own compensation, asked here of every one."""
    return SourceBand(upper=upper, below=below, reason="paper, of its own compensation")


def _quantities() -> Iterator[StudyQuantity]:
    for way in _COMPENSATIONS:
        title = f"{_TITLES[way]}: largest error of pressure on the bench, held-out parts"
        yield StudyQuantity(f"bench_{way}", title, _PRESSURE, NOT_ASKED, status="calibrated", digits=2)
    for way, statistic in product(_TITLES, _STATISTICS):
        yield StudyQuantity(
            f"pressure_{statistic}_{way}",
            f"{_TITLES[way]}: largest error of pressure in a judged stop, {statistic}",
            _PRESSURE,
            "below 2 %",
            status="predicted",
            band=_bounded(_BOUND, below=True) if way in _COMPENSATIONS else None,
            digits=2,
        )
    for way, statistic in product(_FORCE_WAYS, _STATISTICS):
        yield StudyQuantity(
            f"force_{statistic}_{way}",
            f"{_TITLES[way]}: largest error of force in a judged stop, {statistic}",
            _FORCE,
            "within +-8 %",
            status="predicted",
            band=_bounded(8.0, below=False) if way in _COMPENSATIONS else None,
            digits=2,
        )
    for name, statistic in product(_ABLATIONS, _STATISTICS):
        what = "any of these" if name == "any" else f"its {name}"
        title = f"thermal, identified on the module without {what}, pressure, {statistic}"
        yield StudyQuantity(
            f"without_{name}_{statistic}", title, _PRESSURE, NOT_ASKED, status="predicted", digits=2
        )
    for name, statistic in product(_WIDE, _STATISTICS):
        title = f"caliper of the library with {_WIDE_CLEARANCE} of clearance: thermal, {_WIDE[name]}"
        title += f", pressure, {statistic}"
        yield StudyQuantity(
            f"wide_{name}_{statistic}", title, _PRESSURE, NOT_ASKED, status="predicted", digits=2
        )


@dataclass(frozen=True, slots=True)
class _Judged:
    """The errors of every way in one judged stop; `vents`: how often its valve vents."""

    case: Case
    vents: int
    errors: Mapping[str, SettingErrors]


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
        f"without_{name}": _without(stop_runner, HARDWARE._replace(**changes), training, inputs, owner)
        for name, changes in _ABLATIONS.items()
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


def _without(
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
    for way in _COMPENSATIONS:
        yield f"bench_{way}", StudyValue(fits.training[way])
    found = {f"pressure_{{}}_{way}": [each.errors[way].pressure_error for each in judged] for way in _TITLES}
    found |= {f"force_{{}}_{way}": [each.errors[way].force_error for each in judged] for way in _FORCE_WAYS}
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
        "command": [each.case.scenario.brake.command.text for each in rows],
        "controller": [each.case.scenario.controller.name for each in rows],
        "vents": [each.vents for each in rows],
    }
    for way in _TITLES:
        columns[f"{way}_pressure_percent"] = [round(each.errors[way].pressure_error, 3) for each in rows]
        true = [round(each.errors[way].true_pressure_error, 3) for each in rows]
        columns[f"{way}_true_pressure_percent"] = true
        columns[f"{way}_force_percent"] = [round(each.errors[way].force_error, 3) for each in rows]
    return columns


def _worst_note(judged: Sequence[_Judged], way: str) -> str:
    """Return where a compensation errs most, and in how many stops its pressure leaves the bound."""
    worst = max(judged, key=lambda each: each.errors[way].pressure_error)
    missed = sum(each.errors[way].pressure_error >= _BOUND for each in judged)
    scenario = worst.case.scenario
    place = f"friction {constant_friction(worst.case):g} from {scenario.initial_speed.text}"
    return (
        f"{_TITLES[way]}: pressure misses {_BOUND:g} % in {missed} of {len(judged)} stops, worst at {place},"
        f" {scenario.brake.command.text} command, {scenario.controller.name}."
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
    axes.axhspan(0.0, _BOUND, color=BAND, zorder=0)
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
