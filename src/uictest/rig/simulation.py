"""A case in, a stop out."""

import math
from dataclasses import dataclass
from typing import Any

from uictest.recording import BRAKE_COMMAND_TIME, ORIGIN, Recording
from uictest.rig.assembly import assemble
from uictest.rig.backends.native import compiled_stop
from uictest.rig.backends.run_stop import SteppedStop, run
from uictest.rig.model.trace import CAR_CHANNELS, WHEELSET_CHANNELS
from uictest.scenario import Case


@dataclass(frozen=True)
class SimulatedStop:
    """What the simulation of a case leaves.

    Attributes:
        measures: record of :data:`uictest.measures.MEASURES`.
        wheelset_measures: four records of :data:`uictest.measures.WHEELSET_MEASURES`.
        recording: channels over time, when asked for.
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
    parameters, rail = assemble(case)
    steps_per_sample = 0 if record_every is None else max(round(record_every / float(parameters.step)), 1)
    outcome = run(compiled_stop(), parameters, rail, steps_per_sample)
    recording = _recording(case, outcome) if steps_per_sample else None
    return SimulatedStop(outcome.measures, outcome.wheelset_measures, recording)


def _recording(case: Case, outcome: SteppedStop) -> Recording:
    names = [
        *CAR_CHANNELS,
        *((f"{name}_{i}", unit) for i in (1, 2, 3, 4) for name, unit in WHEELSET_CHANNELS),
    ]
    channels = {name: outcome.trace[:, k].copy() for k, (name, _) in enumerate(names)}
    return Recording(channels, dict(names), _facts(case, outcome))


def _facts(case: Case, outcome: SteppedStop) -> dict[str, str]:
    """What a recording says beside its samples; when a wheelset first slid is known to the step only here."""
    facts = {ORIGIN: "simulated stop", "case": case.id, BRAKE_COMMAND_TIME: "0 s"}
    if math.isfinite(outcome.measures.sliding_time):
        facts["sliding_time"] = f"{outcome.measures.sliding_time:.6g}"
    return facts
