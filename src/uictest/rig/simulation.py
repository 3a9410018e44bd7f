"""A case in, a stop out."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from uictest.recording import BRAKE_COMMAND_TIME, ORIGIN, Recording
from uictest.rig.assembly import assemble, controller_of
from uictest.rig.backends.finished_stop import FinishedStop, run_to_end
from uictest.rig.backends.native import compiled_stop, stops_are_compiled
from uictest.rig.model.trace import CAR_CHANNELS, DISC_CHANNELS, WHEELSET_CHANNELS
from uictest.scenario import Case


@dataclass(frozen=True)
class SimulatedStop:
    """Result of the simulation of a case.

    Attributes:
        measures: record of :data:`uictest.measures.STOP_MEASURES`.
        wheelset_measures: four records of :data:`uictest.measures.WHEELSET_MEASURES`.
        recording: channels over time, if requested.
    """

    measures: Any
    wheelset_measures: Any
    recording: Recording | None = None


def simulate(case: Case, record_every: float | None = None) -> SimulatedStop:
    """Simulate a case on the compiled rig; other threads may run meanwhile.

    Args:
        case: the case.
        record_every: time between two samples of a recording, s, in whole base steps; None: no recording.
    """
    inputs = assemble(case)
    step = float(inputs.parameters.step)
    steps_per_sample = 0 if record_every is None else max(round(record_every / step), 1)
    finished = run_to_end(compiled_stop(inputs.controller), inputs, steps_per_sample)
    recording = _recording(case, finished) if steps_per_sample else None
    return SimulatedStop(finished.measures, finished.wheelset_measures, recording)


def is_compiled(cases: Iterable[Case]) -> bool:
    """Return whether the cache holds the rig with the controllers of these cases."""
    return stops_are_compiled(controller_of(case.scenario) for case in cases)


def _recording(case: Case, finished: FinishedStop) -> Recording:
    """Return the channels of the train, then those of each wheelset, without what is not modelled."""
    train, wheelsets = finished.trace
    modelled = case.scenario.brake.models_disc_temperature
    recorded = [each for each in WHEELSET_CHANNELS if modelled or each[0] not in DISC_CHANNELS]
    channels = {name: train[name].copy() for name, _ in CAR_CHANNELS}
    units = dict(CAR_CHANNELS)
    for i in range(4):
        channels |= {f"{name}_{i + 1}": wheelsets[name][:, i].copy() for name, _ in recorded}
        units |= {f"{name}_{i + 1}": unit for name, unit in recorded}
    return Recording(channels, units, _facts(case, finished))


def _facts(case: Case, finished: FinishedStop) -> dict[str, str]:
    """Return the metadata of a recording; the instant of the first sliding is more exact than the samples."""
    facts = {ORIGIN: "simulated stop", "case": case.id, BRAKE_COMMAND_TIME: "0 s"}
    if math.isfinite(finished.measures.sliding_time):
        facts["sliding_time"] = f"{finished.measures.sliding_time:.6g}"
    return facts
