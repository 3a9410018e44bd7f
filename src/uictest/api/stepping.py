"""The rig as a Python object: reset it, step it, look at its true state."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from uictest.controllers import (
    CONTRACTS,
    NO_REDUCTION,
    ControllerError,
    Inputs,
    Outputs,
    read_inputs,
    write_outputs,
)
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import library, scenario
from uictest.rig import SteppedStop, assemble, bench, noise_key_text, recording_of_stop

FourValues = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class RigState:
    """The rig at one instant; wheelset 0 is the leading one, pressures are gauge.

    Attributes:
        time: since the brake command, s.
        distance: since the brake command, m.
        train_speed: m/s.
        wheel_speed: circumferential, m/s.
        slide: 1 - wheel speed / train speed; 0 below 1 m/s.
        friction: friction coefficient of the rail under the wheelset.
        tank_pressure: of the module of each wheelset, Pa.
        clamping_force: of one caliper, N.
        brake_torque: on the wheelset, N m.
        reservoir_pressure: Pa.
    """

    time: float
    distance: float
    train_speed: float
    wheel_speed: FourValues
    slide: FourValues
    friction: FourValues
    tank_pressure: FourValues
    clamping_force: FourValues
    brake_torque: FourValues
    reservoir_pressure: float


def state_of(memory: Any) -> RigState:
    """Return the present state from a record of :data:`uictest.rig.STOP_MEMORY`."""
    train, modules = memory["train"][0], memory["modules"][0]
    return RigState(
        time=float(train["time"]),
        distance=float(train["distance"]),
        train_speed=float(train["speed"]),
        wheel_speed=_four(modules, "wheel_speed"),
        slide=_four(modules, "slide"),
        friction=_four(modules, "friction"),
        tank_pressure=_four(modules, "tank_pressure"),
        clamping_force=_four(modules, "clamping_force"),
        brake_torque=_four(modules, "brake_torque"),
        reservoir_pressure=float(train["reservoir_pressure"]),
    )


def _four(modules: Any, name: str) -> FourValues:
    leading, second, third, trailing = modules[name].tolist()
    return leading, second, third, trailing


Magnets = Sequence[bool | int]
_NOT_ENERGISED: Final = (0, 0, 0, 0)
_LARGEST_SEED: Final = 2**32 - 1


class Rig:
    """The rig of one case, stepped from outside, one controller cycle at a time.

        rig = uictest.Rig("slip.yaml")
        inputs = rig.reset()
        while not rig.stopped:
            inputs = rig.step(hold=[0, 0, 0, 0], vent=[0, 0, 0, 0])
        print(rig.result().outcome)

    The controller that the scenario names plays no part, but its cycle time holds. With `rig.wsp: bypassed`
    the valves fill whatever is commanded. Nor does `repeat`: `reset(seed=...)` begins each further stop.
    """

    def __init__(
        self,
        path: str | Path,
        case: str | None = None,
        *,
        trust: Iterable[str | Path] = (),
        record: float | None = None,
        contract: int = 1,
    ) -> None:
        """Read a scenario; no stop is simulated yet.

        Args:
            path: scenario file, or the name of one that ships.
            case: id of the case, where the file has several.
            trust: folders that the scenario may refer to, besides its own and the working folder.
            record: samples per second for :meth:`recording`; None: no recording.
            contract: version of the contract that whoever steps it keeps: with version 1 a dynamic brake
                drops at the first hold or vent, with version 2 commands can reduce it.

        Raises:
            uictest.plans.scenario.ScenarioErrors: the file is invalid; the message has every error in it.
            ValueError: no such case, several and none is named, or one that is a car of a train; `record` is
                not positive, or there is no such contract.
        """
        if contract not in CONTRACTS:
            raise ValueError(f"contract is {contract!r}, expected {' or '.join(map(str, CONTRACTS))}")
        if record is not None and not 0.0 < record < math.inf:
            raise ValueError(f"record is {record!r}, expected samples per second or None")
        place = library.named_scenario(Path(path))
        cases = scenario.load([place], trusted=[Path(folder) for folder in trust])
        self.case = bench.identified(scenario.chosen_case(cases, case))
        if (train := self.case.train) is not None:
            raise ValueError(f"{self.case.id} is {train.label}: a rig that is stepped is a car alone")
        self._record = record
        self._contract = contract
        self._stop: SteppedStop | None = None
        self._noise_key = ""

    @property
    def cycle_time(self) -> float:
        """Time from one step to the next, s."""
        return float(self.case.scenario.controller.cycle_time)

    def reset(self, seed: int | None = None) -> Inputs:
        """Begin a stop and return what the sensors show at the brake command.

        Args:
            seed: of sensor noise and random rails, 0 to 2^32 - 1; None: that of the scenario. The same seed
                gives the same stop, to the bit.

        Raises ValueError for another seed. The first call on a machine compiles the rig (about 15 s).
        """
        inputs = assemble(self.case)
        self._noise_key = noise_key_text(inputs.parameters)
        inputs.parameters["controller_contract"] = self._contract
        if seed is not None:
            inputs.parameters["seed"] = _checked_seed(seed)
        step = float(inputs.parameters["step"])
        steps_per_sample = 0 if self._record is None else max(round(1.0 / (self._record * step)), 1)
        self._stop = SteppedStop(inputs, steps_per_sample)
        return read_inputs(self._stop.inputs)

    def step(
        self,
        outputs: Outputs | None = None,
        *,
        hold: Magnets = _NOT_ENERGISED,
        vent: Magnets = _NOT_ENERGISED,
        reference_speed: float = math.nan,
        diagnosis: int = 0,
        dynamic_reduction: Sequence[float] | None = None,
        sand_request: Magnets | None = None,
        track_brake_request: bool | int | None = None,
    ) -> Inputs:
        """Carry out commands for one controller cycle and return what the sensors show at its end.

        Args:
            outputs: the commands; or, instead, each of the following.
            hold: holding magnets, 0 or 1, one per wheelset.
            vent: venting magnets, 0 or 1, one per wheelset; vent without hold is forbidden.
            reference_speed: estimate of the train's speed for the recording, m/s.
            diagnosis: 32 bits for the recording.
            dynamic_reduction: share taken off the dynamic brake, 0 to 1, one per wheelset. This and the next
                two only with `contract=2`.
            sand_request: 0 or 1, one per wheelset, for sanders with `when: requested`.
            track_brake_request: 0 or 1; acts where the scenario's `brake.track` says `when: requested`.

        Raises:
            RuntimeError: before :meth:`reset`, or after the end of the stop.
            ValueError: commands that no valve can carry out; the stop stays where it is.
        """
        stop = self._running()
        requested = dynamic_reduction, sand_request, track_brake_request
        _write(stop, outputs or Outputs(hold, vent, reference_speed, diagnosis, *requested), self._contract)
        stop.step()
        _reject_failure(stop)
        return read_inputs(stop.inputs)

    @property
    def stopped(self) -> bool:
        """Whether the stop has ended: the train stands, or the scenario's longest duration has passed."""
        return self._begun().has_ended

    @property
    def stands(self) -> bool:
        """Whether the train stands."""
        return self._begun().stands

    @property
    def state(self) -> RigState:
        """The true state at present. Raises RuntimeError before :meth:`reset`."""
        return state_of(self._begun().memory)

    def result(self) -> evaluation.CaseResult:
        """Return the judged result of the stop, as `uictest run` judges it; RuntimeError before its end."""
        finished = self._ended().finished()
        result = evaluation.evaluate_simulated(self.case, finished.measures, finished.wheelset_measures)
        return replace(result, noise_key=self._noise_key)

    def recording(self) -> Recording:
        """Return the recording of the stop; RuntimeError before its end or without `record`."""
        if self._record is None:
            raise RuntimeError("nothing was recorded: create the rig with record=100 (samples per second)")
        finished = replace(self._ended().finished(), contract=self._contract)
        return recording_of_stop(self.case, finished, from_outside=True)

    def _begun(self) -> SteppedStop:
        if self._stop is None:
            raise RuntimeError("no stop has begun: call reset() first")
        return self._stop

    def _running(self) -> SteppedStop:
        stop = self._begun()
        if stop.has_ended:
            raise RuntimeError(f"the stop has ended after {stop.inputs['time']:g} s: call reset()")
        return stop

    def _ended(self) -> SteppedStop:
        stop = self._begun()
        if not stop.has_ended:
            raise RuntimeError(f"the stop has not ended after {stop.inputs['time']:g} s: call step()")
        return stop


def _checked_seed(seed: int) -> int:
    if isinstance(seed, float) or not 0 <= int(seed) <= _LARGEST_SEED:
        raise ValueError(f"seed is {seed!r}, expected a whole number from 0 to {_LARGEST_SEED}")
    return int(seed)


def _write(stop: SteppedStop, outputs: Outputs, contract: int) -> None:
    try:
        write_outputs(stop.outputs, outputs, contract)
    except ControllerError as error:
        raise ValueError(str(error)) from None


def _reject_failure(stop: SteppedStop) -> None:
    """Raise ValueError where machine code has refused the commands: what `_write` lets pass."""
    if failure := stop.exchange["failure"]:
        place = int(stop.exchange["failed_wheelset"])
        if failure == NO_REDUCTION:
            found = stop.exchange["dynamic_reduction"][place]
            raise ValueError(f"dynamic_reduction[{place}] is {found}, expected 0 to 1")
        raise ValueError(
            f"vent[{place}] is 1 and hold[{place}] is 0, which is forbidden: both are 1 in order to vent"
        )
