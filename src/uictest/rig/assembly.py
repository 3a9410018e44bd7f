"""From a case, as a user wrote it, to the numbers that the rig steps.

What sets parameters is a function of a few sections or numbers of the scenario: its arguments, by the names
of :data:`SECTIONS`, are all that it can read. So a scenario that differs from the one before in a section
needs only the functions that are given it.
"""

import hashlib
import inspect
import json
import math
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from operator import attrgetter, is_not
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import CONTROLLERS, Config, ControllerProgram
from uictest.core.record import Record, scenario_values
from uictest.plans.faults import FAULT_KINDS, MOST_FAULTS, SPEED_SENSOR, Effects
from uictest.plans.scenario import WHEELSET_NUMBERS, Case, Drag, Fault, Quantity, Scenario, wheelset_value
from uictest.rig.brake_assembly import BRAKE
from uictest.rig.model.controller import CHOICES, EXTERNAL
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS, Parameters, WheelsetParameters
from uictest.rig.model.rail import FACTORS, FRICTIONS, PLACES, ROWS, TIMES
from uictest.rig.rail_assembly import RAIL, friction_along_track, friction_factor_over_time
from uictest.rig.train_stop import StopInputs
from uictest.rig.vehicle_assembly import OF_WHEELSET, VALUES_OF_WHEELSET, VEHICLE

SECTIONS: Final = {
    **{name: name for name in ("brake", "vehicle", "rail", "rig", "controller", "faults", "sanders")},
    **{name: name for name in ("initial_speed", "until", "drag")},
    "time_step": "simulation.time_step",
    "maximum_duration": "simulation.maximum_duration",
    "cycle_time": "controller.cycle_time",
    "pad": "brake.pad",
    "motors": "brake.dynamic",
    "track_brake": "brake.track",
    "system": "brake.system",
    "supply": "brake.supply",
    "air": "brake.system.air",
    "disc": "brake.system.disc",
    "caliper": "rig.caliper",
    "sensors": "rig.sensors",
    "cylinder": "rig.compensation_model.cylinder",
    "cylinder_sampling_time": "rig.compensation_model.sampling_time",
    "modelled_air": "rig.compensation_model.air",
    "hysteresis": "rig.compensation_model.hysteresis",
    "wheelset_mass": "vehicle.wheelset.mass",
    "regular_radius": "vehicle.wheelset.radius",
}
"""Argument of a function that sets parameters -> key of the scenario that it is given."""


class Assignment(NamedTuple):
    """A function that sets some fields of a record, and its arguments after the record, from a scenario."""

    function: Callable[..., None]
    arguments: tuple[Callable[[Scenario], Any], ...]

    def given(self, scenario: Scenario) -> list[Any]:
        """Return the arguments of the function from a scenario."""
        return [argument(scenario) for argument in self.arguments]


def _of_wheelset(number: int, name: str) -> Callable[[Scenario], Any]:
    return lambda scenario: wheelset_value(scenario, number, name)


def _copying(field: str, convert: Callable[[float], float] | None) -> Callable[[Any, Any], None]:
    def copy(parameters: Any, value: Any) -> None:
        setattr(parameters, field, value if convert is None else convert(value))

    return copy


def _names_of_arguments(function: Callable[..., None]) -> list[str]:
    return list(inspect.signature(function).parameters)[1:]


def _set_cycles(p: Parameters, time_step: float, maximum_duration: float, cycle_time: float) -> None:
    cycle = float(cycle_time)
    p.steps_per_cycle = round(cycle / float(time_step))
    p.cycles = math.ceil(maximum_duration / cycle - 1e-9)


def _set_end(p: Parameters, until: float | None, drag: Drag | None) -> None:
    p.end_speed = 0.0 if until is None else until
    p.drag_duration = p.drag_speed = 0.0
    if drag is not None:
        p.drag_duration, p.drag_speed = drag.duration, drag.speed


def _set_controller(p: Parameters, controller: Any) -> None:
    """Set the controller in use and its parameters; those of the others are zero and never read."""
    chosen = EXTERNAL if controller.program is not None else CONTROLLERS[controller.algorithm]
    p.controller = CHOICES.index(chosen)
    p.controller_contract = chosen.contract
    p.controller_step = p.controller_handle = p.controller_exchange = 0  # none from outside is open yet
    declared = chosen.declared_parameters()
    for other in CONTROLLERS.values():
        for field in other.declared_parameters():
            setattr(p, field, getattr(controller, field) if field in declared else 0.0)


_CONVERTED = frozenset({"travel_time", "release_time"})
"""Effects of faults whose tables hold something else: shares of a step, controller cycles."""


def _set_faults(p: Parameters, faults: tuple[Fault, ...], time_step: float, cycle_time: float) -> None:
    step, cycle = float(time_step), float(cycle_time)
    blank = [0.0] * (MOST_FAULTS - len(faults))
    kinds = [FAULT_KINDS[fault.part, fault.kind] for fault in faults]
    p.fault_count = len(faults)
    p.has_leaks = float(any(fault.effects.tank_leak + fault.effects.line_leak > 0.0 for fault in faults))
    p.fault_begin_time, p.fault_begin_speed, p.fault_begin_distance = _tables_of_instants(
        [fault.at for fault in faults], step
    )
    p.fault_end_time, p.fault_end_speed, p.fault_end_distance = _tables_of_instants(
        [fault.until for fault in faults], step
    )
    p.fault_wheelset = [*(float((fault.wheelset or 1) - 1) for fault in faults), *blank]
    p.fault_of_wheelset = [*(float(fault.wheelset is not None) for fault in faults), *blank]
    p.fault_of_speed_sensor = [*(float(fault.part == SPEED_SENSOR) for fault in faults), *blank]
    p.fault_report_required = [*(float(kind.report == "required") for kind in kinds), *blank]
    effects = [fault.effects for fault in faults] + [Effects()] * len(blank)
    for name in Effects._fields:
        if name not in _CONVERTED:
            setattr(p, f"fault_{name}", [float(getattr(effect, name)) for effect in effects])
    p.fault_travel_per_step = [min(step / max(effect.travel_time, step), 1.0) for effect in effects]
    p.fault_release_cycles = [
        math.ceil(time / cycle - 1e-9) if math.isfinite(time) else math.inf
        for time in (effect.release_time for effect in effects)
    ]


def _tables_of_instants(instants: Sequence[Quantity | None], step: float) -> Iterator[list[float]]:
    """Yield tables of the times, speeds and distances that are reached together at each instant.

    Without an instant, and beyond the last fault, never. Times are half a step early: what they are compared
    with is a whole number of steps.
    """
    table = [*instants, *[None] * (MOST_FAULTS - len(instants))]
    yield [
        math.inf if each is None else float(each) - 0.5 * step if each.unit == "s" else -math.inf
        for each in table
    ]
    yield [float(each) if each is not None and each.unit == "m/s" else math.inf for each in table]
    yield [float(each) if each is not None and each.unit == "m" else -math.inf for each in table]


ASSIGNMENTS: Final = (
    *(
        Assignment(_copying(field, source.convert), (attrgetter(source.key),))
        for field, source in scenario_values(Parameters).items()
    ),
    *(
        Assignment(function, tuple(attrgetter(SECTIONS[name]) for name in _names_of_arguments(function)))
        for function in (*BRAKE, *VEHICLE, *RAIL, _set_cycles, _set_end, _set_controller, _set_faults)
    ),
)
"""What sets all parameters but `noise_key`."""
WHEELSET_ASSIGNMENTS: Final = tuple(
    (
        *(
            Assignment(_copying(field, None), (_of_wheelset(number, source.key),))
            for field, source in scenario_values(WheelsetParameters).items()
        ),
        *(
            Assignment(
                function,
                tuple(
                    _of_wheelset(number, VALUES_OF_WHEELSET[name])
                    if name in VALUES_OF_WHEELSET
                    else attrgetter(SECTIONS[name])
                    for name in _names_of_arguments(function)
                ),
            )
            for function in OF_WHEELSET
        ),
    )
    for number in WHEELSET_NUMBERS
)
"""For each wheelset, what sets all of its parameters."""


class RecordAssembler:
    """Assembles one record of scenario after scenario.

    A function is called again where something that it is given is not the same object as in the scenario
    before: sections are frozen, and cases share those that they do not differ in.
    """

    def __init__(self, layout: Any, assignments: Sequence[Assignment], left_out: frozenset[str]) -> None:
        self._layout, self._assignments, self._fields = layout, assignments, {*layout.names} - left_out
        self._last: tuple[list[list[Any]], NDArray[Any]] | None = None

    def record(self, scenario: Scenario) -> NDArray[Any]:
        """Return the record of a scenario, shape (1,); the caller may change it."""
        last = self._last  # replaced as a whole: other threads assemble, too
        given = [assignment.given(scenario) for assignment in self._assignments]
        parameters = Record()
        for k, assignment in enumerate(self._assignments):
            if last is None or any(map(is_not, given[k], last[0][k])):
                assignment.function(parameters, *given[k])
        values = vars(parameters)
        if last is None and (missing := self._fields ^ set(values)):
            raise AssertionError(f"parameters without a value, or unknown: {', '.join(sorted(missing))}")
        record = np.zeros(1, self._layout) if last is None else last[1].copy()
        for name, value in values.items():
            record[name] = value
        if values:
            self._last = given, record.copy()
        return record


_PARAMETERS: Final = RecordAssembler(PARAMETERS, ASSIGNMENTS, frozenset({"noise_key"}))
_WHEELSETS: Final = [
    RecordAssembler(WHEELSET_PARAMETERS, assignments, frozenset()) for assignments in WHEELSET_ASSIGNMENTS
]


def parameter_record(scenario: Scenario) -> NDArray[Any]:
    """Return the record of :data:`~uictest.rig.model.parameters.PARAMETERS`, without its noise key."""
    return _PARAMETERS.record(scenario)


def assemble(case: Case) -> StopInputs:
    """Return the inputs of the rig for the stop of a case.

    Raises ValueError where its compensation is still to be identified, see `uictest.rig.bench.identified`,
    and for a car of a train, which does not run alone.
    """
    if case.train is not None:
        raise ValueError(
            f"{case.id} is {case.train.label}: here a car runs alone; `uictest run` and `sweep` take trains"
        )
    scenario = case.scenario
    if scenario.rig.compensation_model.to_identify and scenario.rig.topology == "one-caliper":
        raise ValueError("rig.compensation_model is to be identified first: uictest.rig.bench.identified")
    record = parameter_record(scenario)
    wheelsets = np.zeros(len(_WHEELSETS), WHEELSET_PARAMETERS)
    for k, assembler in enumerate(_WHEELSETS):
        wheelsets[k] = assembler.record(scenario)[0]
    rail = friction_laws(scenario)
    record["noise_key"] = noise_key(record[0], wheelsets, rail)
    parameters = record[0]
    program = scenario.controller.program
    if program is None:
        return StopInputs(parameters, wheelsets, rail)
    config = controller_config(parameters, wheelsets, program)
    named = replace(config, case_sha256=case_sha256(parameters, wheelsets, rail, program))
    return StopInputs(parameters, wheelsets, rail, program, named)


def friction_laws(scenario: Scenario) -> NDArray[np.float64]:
    """Return friction along the track and its factor over time, shape (4, points); rows are filled up."""
    along, over_time = friction_along_track(scenario.rail), friction_factor_over_time(scenario.rail)
    laws = np.zeros((ROWS, max(len(along), len(over_time))))
    laws[[PLACES, FRICTIONS], : len(along)] = np.array(along).T
    laws[[TIMES, FACTORS], : len(over_time)] = np.array(over_time).T
    return laws


def case_sha256(
    parameters: Any, wheelset_parameters: Any, rail: NDArray[np.float64], program: ControllerProgram
) -> str:
    """Return the SHA-256 that names a stop: of the bytes of the three records that the rig is given, then of
    the controller's parameters as JSON in UTF-8.

    Stops with the same one are the same stop for a controller, in one version of the package: criteria,
    texts of the scenario and the id of the case have no part in it.
    """
    records = parameters.tobytes(), wheelset_parameters.tobytes(), np.ascontiguousarray(rail).tobytes()
    return hashlib.sha256(b"".join(records) + program.parameters.encode()).hexdigest()


def controller_config(parameters: Any, wheelset_parameters: Any, program: ControllerProgram) -> Config:
    """Return the configuration of a controller from outside for a stop with these records."""
    radii = wheelset_parameters["configured_radius"].tolist()
    cycle_time, initial_speed = float(parameters["cycle_time"]), float(parameters["initial_speed"])
    return Config(len(radii), cycle_time, initial_speed, tuple(radii), json.loads(program.parameters))


_KEY_OF_STOP: Final = ("initial_speed", "commanded_pressure", "static_wheel_load")
_KEY_OF_WHEELSETS: Final = ("wheel_radius", "brake_force", "reference_pad_friction")


def noise_key(parameters: Any, wheelset_parameters: Any, rail: NDArray[np.float64]) -> int:
    """Return the noise key of a stop: CRC-32 of initial speed, commanded pressure and wheel load, of each
    wheelset's radius, brake force and pad friction, and of the friction along the track and over time.

    With the seed the key decides every draw. Stops that differ in other values share their noise, so that two
    controllers, two compensations or two topologies meet the same in the same stop. So few values decide
    because any further one would change the noise of every stop. Arguments as in :class:`StopInputs`; points
    of the rail beyond those of a law do not count.
    """
    along_track = rail[PLACES : FRICTIONS + 1, : int(parameters["friction_points"])]
    over_time = rail[TIMES : FACTORS + 1, : int(parameters["friction_times"])]
    numbers = [
        [parameters[name] for name in _KEY_OF_STOP],
        *(wheelset_parameters[name] for name in _KEY_OF_WHEELSETS),
        *(along_track.ravel(), over_time.ravel()),
    ]
    return zlib.crc32(np.concatenate(numbers).tobytes())


def noise_key_text(parameters: np.void) -> str:
    """Return the key in a parameter record as results state it: eight hexadecimal digits."""
    return f"{int(parameters['noise_key']):08x}"
