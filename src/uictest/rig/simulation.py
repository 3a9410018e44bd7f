"""A case in, a stop out."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ResponseTimes
from uictest.core.recording import BRAKE_COMMAND_TIME, ORIGIN, TRACK_BRAKES_BESIDE, Recording
from uictest.plans.scenario import Case
from uictest.rig.assembly import assemble, noise_key_text
from uictest.rig.external.workers import RunInputs, RunTrain, Workers
from uictest.rig.model.trace import CAR_CHANNELS, CHANNELS_OF, WHEELSET_CHANNELS
from uictest.rig.reference_distance import measures_with_reference
from uictest.rig.train_assembly import Coupling, assemble_train, coupling_of
from uictest.rig.train_stop import FinishedStop, TrainInputs, TrainStop, empty_trace


class CouplerPeaks(NamedTuple):
    """The largest forces with which a coupler pulled and pushed, N."""

    pull: float
    push: float


def peaks_beside(couplers: NDArray[Any]) -> list[tuple[CouplerPeaks | None, CouplerPeaks | None]]:
    """Return those of the couplers ahead of and behind each car, None where there is none.

    Args:
        couplers: records of :data:`~uictest.rig.model.state.COUPLER`, from the leading one.
    """
    peaks = [CouplerPeaks(float(each["largest_pull"]), float(each["largest_push"])) for each in couplers]
    return list(pairwise([None, *peaks, None]))


@dataclass(frozen=True)
class SimulatedStop:
    """Result of the simulation of a case.

    Attributes:
        measures: record of :data:`uictest.core.measures.STOP_MEASURES`.
        wheelset_measures: four records of :data:`uictest.core.measures.WHEELSET_MEASURES`.
        recording: channels over time, if requested.
        controller_version: what a controller from outside says of itself.
        controller_contract: version of the contract that it kept; 0: the controller is built in.
        response_times: how it answered, where cycles were paced by the clock.
        case_sha256: what it was given to name the stop, see :func:`uictest.rig.assembly.case_sha256`.
        noise_key: of the sensors' noise, see :mod:`uictest.rig.train_stop`, as eight hexadecimal digits.
        coupler_ahead: largest forces in the coupler to the car ahead, None where there is none.
        coupler_behind: largest forces in the coupler to the car behind, None where there is none.
        controller_output: what a controller from outside printed, where that is kept.
    """

    measures: Any
    wheelset_measures: Any
    recording: Recording | None = None
    controller_version: str = ""
    controller_contract: int = 0
    response_times: ResponseTimes | None = None
    case_sha256: str = ""
    noise_key: str = ""
    coupler_ahead: CouplerPeaks | None = None
    coupler_behind: CouplerPeaks | None = None
    controller_output: str = ""


def simulate(case: Case, record_every: float | None = None, run: RunInputs | None = None) -> SimulatedStop:
    """Simulate a case; other threads may run meanwhile.

    Args:
        case: the case.
        record_every: time between two samples of a recording, s, in whole base steps; None: no recording. A
            case that is a car of a train runs with the whole train.
        run: what runs the stop [default: a child process if the controller comes from outside].

    Raises:
        ControllerError: when a controller from outside failed.
    """
    if case.train is not None:
        return simulate_cars([case], record_every)[0]
    inputs = assemble(case)
    step = float(inputs.parameters.step)
    steps_per_sample = 0 if record_every is None else max(round(record_every / step), 1)
    if run is None:
        with Workers() as workers:
            finished = workers.run(inputs, steps_per_sample)
    else:
        finished = run(inputs, steps_per_sample)
    stop = _stop_of_car(case, finished, inputs.config, recorded=steps_per_sample > 0)
    measures = measures_with_reference(finished.measures, inputs)
    return replace(stop, measures=measures, noise_key=noise_key_text(inputs.parameters))


def simulate_cars(
    cases: Sequence[Case], record_every: float | None = None, run: RunTrain | None = None
) -> list[SimulatedStop]:
    """Simulate a train once and return the stops of some of its cars.

    Args:
        cases: cars of one train.
        record_every: as for :func:`simulate`.
        run: what runs the stop [default: a child process if a controller comes from outside].

    Raises:
        ControllerError: when a controller from outside failed.
    """
    inputs, step = _inputs_of(cases), float(cases[0].scenario.simulation.time_step)
    steps_per_sample = 0 if record_every is None else max(round(record_every / step), 1)
    with Workers() as workers:
        stop = (run or workers.run_train)(inputs, steps_per_sample)
    return _stops_of_train(cases, inputs, stop.cars, stop.couplers, recorded=steps_per_sample > 0)


def simulate_trains(
    trains: Sequence[Sequence[Case]], noise_of: Case | None = None, run: RunTrain | None = None
) -> list[list[SimulatedStop]]:
    """Simulate trains side by side in lanes, each as :func:`simulate_cars` does without a recording.

    Trains with controllers from outside run one after the other.

    Args:
        trains: cars of each train.
        noise_of: car of a train whose noise all meet [default: each its own].
        run: as for :func:`simulate_cars`.

    Raises:
        ControllerError: when a controller from outside failed.
    """
    from uictest.rig.lanes import run_trains_in_lanes  # single stops do without them

    inputs = [_inputs_of(cases) for cases in trains]
    if noise_of is not None:
        keys = _inputs_of([noise_of]).parameters["noise_key"]
        for k, train_inputs in enumerate(inputs):
            train_inputs.parameters["noise_key"] = keys
            configs = (config and replace(config, case_sha256="") for config in train_inputs.configs)
            inputs[k] = train_inputs._replace(configs=tuple(configs))
    in_lanes = iter(
        run_trains_in_lanes([train_inputs for train_inputs in inputs if not train_inputs.from_outside])
    )
    stops: list[list[SimulatedStop]] = []
    with Workers() as workers:
        for cases, train in zip(trains, inputs, strict=True):
            if train.from_outside:
                stop = (run or workers.run_train)(train, 0)
                stops.append(_stops_of_train(cases, train, stop.cars, stop.couplers))
            else:
                of_lane = next(in_lanes)
                pairs = zip(of_lane.measures, of_lane.wheelset_measures.view(np.recarray), strict=True)
                cars = [FinishedStop(*pair, None, None, empty_trace(1, 0)) for pair in pairs]
                stops.append(_stops_of_train(cases, train, cars, of_lane.couplers))
    return stops


def run_coupled(
    cases: Sequence[Case], coupling: Coupling, steps_per_sample: int = 0, run: RunTrain | None = None
) -> TrainStop:
    """Run one stop of a train.

    Args:
        cases: one for each car, from the leading one, all with the same rail.
        coupling: between them.
        steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
        run: what runs it [default: a child process if a controller comes from outside].

    Raises:
        ValueError: where cars differ in what a train has only once, or cannot have their controllers.
        ControllerError: when a controller from outside failed.
    """
    inputs = assemble_train(cases, coupling)
    if run is not None:
        return run(inputs, steps_per_sample)
    with Workers() as workers:
        return workers.run_train(inputs, steps_per_sample)


def sha256_of_case(case: Case) -> str:
    """Return the SHA-256 that a controller from outside is given with a case; empty if it is built in."""
    config = assemble(case).config if case.train is None else _inputs_of([case]).configs[_car_index(case)]
    return "" if config is None else config.case_sha256


def _inputs_of(cases: Sequence[Case]) -> TrainInputs:
    cars = list(cases[0].cars)
    for case in cases:
        cars[_car_index(case)] = replace(case, train=None)  # as if it ran alone
    return assemble_train(cars, coupling_of(cars[0].scenario))


def _car_index(case: Case) -> int:
    assert case.train is not None
    return case.train.number - 1


def _stops_of_train(
    cases: Sequence[Case],
    inputs: TrainInputs,
    finished: Sequence[FinishedStop],
    couplers: NDArray[Any],
    *,
    recorded: bool = False,
) -> list[SimulatedStop]:
    peaks = peaks_beside(couplers)

    def of_car(case: Case) -> SimulatedStop:
        index = _car_index(case)
        stop = _stop_of_car(case, finished[index], inputs.configs[index], recorded=recorded)
        return replace(
            stop,
            noise_key=noise_key_text(inputs.parameters[index]),
            coupler_ahead=peaks[index][0],
            coupler_behind=peaks[index][1],
        )

    return [of_car(case) for case in cases]


def _stop_of_car(
    case: Case, finished: FinishedStop, config: Config | None, *, recorded: bool
) -> SimulatedStop:
    """Return a stop of a car, alone or in a train; `config` is that of a controller from outside."""
    from_outside = config is not None
    recording = recording_of_stop(case, finished, from_outside=from_outside) if recorded else None
    if recording is not None:
        controller = case.scenario.controller
        version = getattr(controller, "version", None) or finished.controller_version
        facts = {"controller": controller.label, **({"controller_version": version} if version else {})}
        recording = replace(recording, metadata={**recording.metadata, **facts})
    return SimulatedStop(
        *(finished.measures, finished.wheelset_measures, recording),
        finished.controller_version,
        finished.contract if from_outside else 0,
        finished.response_times,
        case_sha256="" if config is None else config.case_sha256,
        controller_output=finished.controller_output,
    )


def recording_of_stop(case: Case, finished: FinishedStop, *, from_outside: bool) -> Recording:
    """Return the channels of the train, then those of each wheelset, without what is not modelled.

    Args:
        case: the case.
        finished: its stop, with a trace.
        from_outside: whether the controller was one from outside, which may have a diagnosis.
    """
    train, wheelsets = finished.trace
    brake, sensors = case.scenario.brake, case.scenario.rig.sensors
    has = {
        "disc temperature": brake.models_disc_temperature,
        "dynamic brake": brake.dynamic,
        "track brake": brake.track,
        "train speed": sensors.train_speed,
        "accelerometer": sensors.acceleration,
        "controller from outside": from_outside,
        "contract version 2": from_outside and finished.contract > 1,
        "sanders": any(car.scenario.sanders for car in case.cars),
        "faults": case.scenario.faults,
    }
    missing = {name for what, names in CHANNELS_OF.items() if not has[what] for name in names}
    units = {name: unit for name, unit in CAR_CHANNELS if name not in missing}
    channels = {name: train[name].copy() for name in units}
    for i in range(4):
        for name, unit in WHEELSET_CHANNELS:
            if name not in missing:
                channels[f"{name}_{i + 1}"] = wheelsets[name][:, i].copy()
                units[f"{name}_{i + 1}"] = unit
    return Recording(channels, units, _facts_of_recording(case, finished))


def _facts_of_recording(case: Case, finished: FinishedStop) -> dict[str, str]:
    """Return the metadata of a recording; the instant of the first sliding is more exact than the samples."""
    facts = {ORIGIN: "simulated stop", "case": case.id, BRAKE_COMMAND_TIME: "0 s"}
    if math.isfinite(finished.measures.sliding_time):
        facts["sliding_time"] = f"{finished.measures.sliding_time:.6g}"
    if finished.measures.track_brake_time_beside > 0.0:
        facts[TRACK_BRAKES_BESIDE] = f"{finished.measures.track_brake_time_beside:.6g} s"
    if case.train is not None:
        facts["train"] = f"{case.train.train}, {case.train.label}"
    if case.scenario.faults:
        facts["faults"] = ", ".join(fault.label for fault in case.scenario.faults)
    return facts
