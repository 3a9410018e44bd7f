"""The rig of a car alone as a Python object: reset it, step it, look at its true state."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, Generic, TypeVar

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
from uictest.rig import SteppedStop, SteppedTrain, assemble, bench, noise_key_text, recording_of_stop

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


def state_of(memory: Any, car: int = 0) -> RigState:
    """Return the present state of a car from the memory of a stop, or of that of a train."""
    train, modules = memory["train"][car], memory["modules"][car]
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


_Stop = TypeVar("_Stop", SteppedStop, SteppedTrain)


class SteppedRig(Generic[_Stop]):
    """What the rig of a car and that of a train have in common."""

    def __init__(self, record: float | None, contract: int) -> None:
        """Check the arguments of a rig; :class:`Rig` explains them. Raises ValueError."""
        if contract not in CONTRACTS:
            raise ValueError(f"contract is {contract!r}, expected {' or '.join(map(str, CONTRACTS))}")
        if record is not None and not 0.0 < record < math.inf:
            raise ValueError(f"record is {record!r}, expected samples per second or None")
        self._record = record
        self._contract = contract
        self._stop: _Stop | None = None

    @property
    def stopped(self) -> bool:
        """Whether the stop has ended: the train stands, or the scenario's longest duration has passed."""
        return self._begun().has_ended

    @property
    def stands(self) -> bool:
        """Whether the train stands."""
        return self._begun().stands

    def _begin(self, parameters: Any, seed: int | None) -> int:
        """Set what holds for a stop in the parameters of a car or more; return its steps per sample."""
        parameters["controller_contract"] = self._contract
        if seed is not None:
            parameters["seed"] = _checked_seed(seed)
        step = float(parameters["step"].flat[0])
        return 0 if self._record is None else max(round(1.0 / (self._record * step)), 1)

    def _begun(self) -> _Stop:
        if self._stop is None:
            raise RuntimeError("no stop has begun: call reset() first")
        return self._stop

    def _running(self) -> _Stop:
        stop = self._begun()
        if stop.has_ended:
            raise RuntimeError(f"the stop has ended after {stop.time:g} s: call reset()")
        return stop

    def _ended(self) -> _Stop:
        stop = self._begun()
        if not stop.has_ended:
            raise RuntimeError(f"the stop has not ended after {stop.time:g} s: call step()")
        return stop

    def _recorded(self) -> _Stop:
        if self._record is None:
            raise RuntimeError("nothing was recorded: create the rig with record=100 (samples per second)")
        return self._ended()


def loaded(path: str | Path, trust: Iterable[str | Path]) -> list[scenario.Case]:
    """Return the cases of a scenario file, or of one that ships."""
    place = library.named_scenario(Path(path))
    return scenario.load([place], trusted=[Path(folder) for folder in trust])


class Rig(SteppedRig[SteppedStop]):
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
        super().__init__(record, contract)
        self.case = bench.identified(scenario.chosen_case(loaded(path, trust), case))
        if (train := self.case.train) is not None:
            raise ValueError(f"{self.case.id} is {train.label}: step its train with uictest.TrainRig")
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
        self._stop = SteppedStop(inputs, self._begin(inputs.parameters, seed))
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
        outputs = outputs or Outputs(hold, vent, reference_speed, diagnosis, *requested)
        write_commands(stop.outputs, outputs, self._contract)
        stop.step()
        reject_failure(stop.exchange)
        return read_inputs(stop.inputs)

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
        finished = replace(self._recorded().finished(), contract=self._contract)
        return recording_of_stop(self.case, finished, from_outside=True)


def _checked_seed(seed: int) -> int:
    if isinstance(seed, float) or not 0 <= int(seed) <= _LARGEST_SEED:
        raise ValueError(f"seed is {seed!r}, expected a whole number from 0 to {_LARGEST_SEED}")
    return int(seed)


def write_commands(record: Any, outputs: Outputs, contract: int) -> None:
    """Write commands into the exchange; ValueError where they are none."""
    try:
        write_outputs(record, outputs, contract)
    except ControllerError as error:
        raise ValueError(str(error)) from None


def reject_failure(exchange: Any) -> None:
    """Raise ValueError where machine code has refused commands: what :func:`write_commands` lets pass."""
    if failure := exchange["failure"]:
        place = int(exchange["failed_wheelset"])
        if failure == NO_REDUCTION:
            found = exchange["dynamic_reduction"][place]
            raise ValueError(f"dynamic_reduction[{place}] is {found}, expected 0 to 1")
        raise ValueError(
            f"vent[{place}] is 1 and hold[{place}] is 0, which is forbidden: both are 1 in order to vent"
        )
