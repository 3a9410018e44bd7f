"""The rig as a Python object: reset it, step it, look at its true state; of a car alone, and of a train."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from operator import index
from pathlib import Path
from typing import Any, Final

from uictest import rig
from uictest.controllers import (
    CONTRACTS,
    NO_REDUCTION,
    NO_REFERENCE,
    ControllerError,
    Inputs,
    Outputs,
    read_inputs,
    write_outputs,
)
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import library, scenario
from uictest.rig import (
    SteppedTrain,
    StopInputs,
    TrainInputs,
    alone,
    assemble,
    assemble_train,
    bench,
    check_requests,
    coupling_of,
    noise_key_text,
    peaks_beside,
    recording_of_stop,
)
from uictest.running import campaign

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
        tank_pressure: tank pressure of the module of each wheelset, Pa.
        clamping_force: clamping force of one caliper, N.
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


def _state_of(memory: Any, car: int) -> RigState:
    train, modules = memory["train"][car], memory["modules"][car]

    def four(name: str) -> FourValues:
        leading, second, third, trailing = modules[name].tolist()
        return leading, second, third, trailing

    return RigState(
        time=float(train["time"]),
        distance=float(train["distance"]),
        train_speed=float(train["speed"]),
        wheel_speed=four("wheel_speed"),
        slide=four("slide"),
        friction=four("friction"),
        tank_pressure=four("tank_pressure"),
        clamping_force=four("clamping_force"),
        brake_torque=four("brake_torque"),
        reservoir_pressure=float(train["reservoir_pressure"]),
    )


_LARGEST_SEED: Final = 2**32 - 1


class SteppedRig:
    """What the rig of a car and that of a train have in common."""

    def __init__(self, cases: Sequence[scenario.Case], record: float | None, contract: int) -> None:
        """Check the arguments of a rig; :class:`Rig` explains them. Raises ValueError."""
        if _whole_number(contract) not in CONTRACTS:
            raise ValueError(f"contract is {contract!r}, expected {' or '.join(map(str, CONTRACTS))}")
        if record is not None and not (isinstance(record, Real) and 0.0 < record < math.inf):
            raise ValueError(f"record is {record!r}, expected samples per second or None")
        self.cases = tuple(bench.identified(case.changed(scenario.with_another_controller)) for case in cases)
        self._record = record
        self._contract = contract
        self._seed: int | None = None
        self._inputs: TrainInputs | None = None
        self._stop: SteppedTrain | None = None

    @property
    def cycle_time(self) -> float:
        """Time from one step to the next, s."""
        return float(self.cases[0].scenario.controller.cycle_time)

    @property
    def stopped(self) -> bool:
        """Whether the stop has ended: the train stands, or the scenario's longest duration has passed."""
        return self._begun_stop().has_ended

    @property
    def stands(self) -> bool:
        """Whether the train stands."""
        return self._begun_stop().stands

    def _begin_stop(self, inputs: TrainInputs, seed: int | None) -> tuple[Inputs, ...]:
        """Begin a stop and return what the sensors of each car show."""
        parameters = inputs.parameters
        try:
            check_requests(self._contract, parameters)
        except ControllerError as error:
            raise ValueError(f"{error}: create the rig with contract=2") from None
        parameters["controller_contract"] = self._contract
        number = None if seed is None else _whole_number(seed)
        if seed is not None and (number is None or not 0 <= number <= _LARGEST_SEED):
            raise ValueError(f"seed is {seed!r}, expected a whole number from 0 to {_LARGEST_SEED}")
        if number is not None:
            parameters["seed"] = number
        step = float(parameters["step"][0])
        every = 0 if self._record is None else max(round(1.0 / (self._record * step)), 1)
        self._seed, self._inputs, self._stop = number, inputs, SteppedTrain(inputs, every)
        return tuple(map(read_inputs, self._stop.inputs))

    def _begun_stop(self) -> SteppedTrain:
        if self._stop is None:
            raise RuntimeError("no stop has begun: call reset() first")
        return self._stop

    def _running_stop(self) -> SteppedTrain:
        stop = self._begun_stop()
        if stop.has_ended:
            raise RuntimeError(f"the stop has ended after {stop.time:g} s: call reset()")
        return stop

    def _ended_stop(self) -> SteppedTrain:
        stop = self._begun_stop()
        if not stop.has_ended:
            raise RuntimeError(f"the stop has not ended after {stop.time:g} s: call step()")
        return stop

    def _carry_out(self, outputs: Sequence[Outputs], names: Sequence[str]) -> tuple[Inputs, ...]:
        """Carry out the commands for each car; an error begins with the name of its car."""
        stop = self._running_stop()
        for record, of_car, name in zip(stop.outputs, outputs, names, strict=True):
            try:
                write_outputs(record, of_car, self._contract)
            except ControllerError as error:
                raise ValueError(f"{name}{error}") from None
        stop.step()
        for exchange, name in zip(stop.memory["exchange"], names, strict=True):
            if exchange["failure"]:
                raise ValueError(f"{name}{_refusal_reason(exchange)}")
        return tuple(map(read_inputs, stop.inputs))

    def _states(self) -> tuple[RigState, ...]:
        memory = self._begun_stop().memory
        return tuple(_state_of(memory, car) for car in range(len(self.cases)))

    def _stated_seed(self) -> dict[str, str]:
        """Return the seed as results and recordings state it; empty where it is the scenario's."""
        return {} if self._seed is None else {"seed": str(self._seed)}

    def _results(self) -> list[evaluation.CaseResult]:
        stop, inputs = self._ended_stop(), self._inputs
        assert inputs is not None
        results = []
        peaks = peaks_beside(stop.memory["couplers"])
        of_cars = zip(self.cases, inputs.parameters, stop.finished(), peaks, strict=True)
        for case, parameters, finished, couplers in of_cars:
            measures = finished.measures
            if case.train is None:  # only a car alone has a reference
                alone_inputs = StopInputs(inputs.parameters[0], inputs.wheelset_parameters[0], inputs.rail)
                measures = rig.measures_with_reference(measures, alone_inputs)
            result = evaluation.evaluate_simulated(
                case, measures, finished.wheelset_measures, couplers=couplers
            )
            results.append(
                replace(
                    result,
                    controller_contract=self._contract,
                    noise_key=noise_key_text(parameters),
                    parameters={**result.parameters, **self._stated_seed()},
                )
            )
        seeded = self.cases
        if self._seed is not None:
            seeded = tuple(case.with_values(seed=self._seed) for case in self.cases)
        return campaign.with_rails(seeded, results)

    def _recordings(self) -> tuple[Recording, ...]:
        if self._record is None:
            raise RuntimeError("nothing was recorded: create the rig with record=100 (samples per second)")
        recordings = []
        for case, finished in zip(self.cases, self._ended_stop().finished(), strict=True):
            stop = replace(finished, contract=self._contract)
            recording = recording_of_stop(case, stop, from_outside=True)
            metadata = {**recording.metadata, **self._stated_seed()}
            recordings.append(replace(recording, metadata=metadata))
        return tuple(recordings)


def _loaded(path: str | Path, trust: Iterable[str | Path]) -> list[scenario.Case]:
    location = library.named_scenario(Path(path))
    return scenario.load([location], trusted=[Path(folder) for folder in trust])


def _whole_number(value: Any) -> int | None:
    """Return a whole number, of numpy, too; None for all else."""
    return None if isinstance(value, bool) or not hasattr(value, "__index__") else index(value)


def _refusal_reason(exchange: Any) -> str:
    """Return the reason for which machine code refused commands that :func:`write_outputs` lets pass."""
    wheelset = int(exchange["failed_wheelset"])
    if exchange["failure"] == NO_REDUCTION:
        return f"dynamic_reduction[{wheelset}] is {exchange['dynamic_reduction'][wheelset]}, expected 0 to 1"
    if exchange["failure"] == NO_REFERENCE:
        return f"reference_speed is {exchange['reference_speed']}, expected a number or NaN"
    return f"vent[{wheelset}] is 1 and hold[{wheelset}] is 0, which is forbidden: both are 1 in order to vent"


Magnets = Sequence[bool | int]
_NOT_ENERGISED: Final = (0, 0, 0, 0)


class Rig(SteppedRig):
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
        cases = _loaded(path, trust)
        only_trains = case is None and all(loaded.train for loaded in cases)
        chosen = cases[0] if only_trains else scenario.chosen_case(cases, case)
        if chosen.train is not None:
            raise ValueError(f"{chosen.id} is {chosen.train.label}: step its train with uictest.TrainRig")
        super().__init__([chosen], record, contract)

    @property
    def case(self) -> scenario.Case:
        """The case, with another controller than the scenario's."""
        return self.cases[0]

    def reset(self, seed: int | None = None) -> Inputs:
        """Begin a stop and return what the sensors show at the brake command.

        Args:
            seed: of sensor noise and random rails, 0 to 2^32 - 1; None: that of the scenario. The same seed
                gives the same stop, to the bit.

        Raises ValueError for another seed.
        """
        return self._begin_stop(alone(assemble(self.case)), seed)[0]

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
        requested = dynamic_reduction, sand_request, track_brake_request
        outputs = outputs or Outputs(hold, vent, reference_speed, diagnosis, *requested)
        return self._carry_out([outputs], [""])[0]

    @property
    def state(self) -> RigState:
        """The true state at present. Raises RuntimeError before :meth:`reset`."""
        return self._states()[0]

    def result(self) -> evaluation.CaseResult:
        """Return the judged result of the stop, as `uictest run` judges it; RuntimeError before its end."""
        return self._results()[0]

    def recording(self) -> Recording:
        """Return the recording of the stop; RuntimeError before its end or without `record`."""
        return self._recordings()[0]


class TrainRig(SteppedRig):
    """The rigs of all cars of a train, stepped from outside, one controller cycle at a time.

        rig = uictest.TrainRig("train-120")
        inputs = rig.reset()
        while not rig.stopped:
            inputs = rig.step([controller.step(own) for controller, own in zip(controllers, inputs)])
        print([result.outcome for result in rig.result()])

    What :class:`uictest.Rig` says of a car holds for each. Everything that there is for each car comes in the
    order of the train, from the leading car on.
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
            path: scenario file, or the name of one that ships. A car alone is a train of one.
            case: id of the train, without a number of a car, where the file has several.
            trust: as for :class:`uictest.Rig`.
            record: likewise.
            contract: likewise; all controllers keep the same.

        Raises:
            uictest.plans.scenario.ScenarioErrors: the file is invalid; the message has every error in it.
            ValueError: no such train, or several and none is named; `record` is not positive, or there is no
                such contract.
        """
        super().__init__(scenario.chosen_train(_loaded(path, trust), case), record, contract)

    def reset(self, seed: int | None = None) -> tuple[Inputs, ...]:
        """Begin a stop and return what the sensors of each car show; as :meth:`uictest.Rig.reset`."""
        cars = self.cases[0].cars
        return self._begin_stop(assemble_train(cars, coupling_of(cars[0].scenario)), seed)

    def step(self, outputs: Sequence[Outputs]) -> tuple[Inputs, ...]:
        """Carry out the commands for one controller cycle and return what the sensors show at its end.

        Args:
            outputs: the commands for each car; also of one that stands, until all cars stand.

        Raises:
            RuntimeError: before :meth:`reset`, or after the end of the stop.
            ValueError: commands that no valve can carry out, the message names the car; no car moves.
        """
        self._running_stop()
        if not isinstance(outputs, Sequence):
            raise ValueError(f"outputs is {type(outputs).__name__}, expected a list, one for each car")
        if len(outputs) != len(self.cases):
            raise ValueError(f"{len(outputs)} outputs, expected one for each of {len(self.cases)} cars")
        return self._carry_out(outputs, [f"car {number}: " for number in range(1, len(outputs) + 1)])

    @property
    def state(self) -> tuple[RigState, ...]:
        """The true state of each car at present. Raises RuntimeError before :meth:`reset`."""
        return self._states()

    @property
    def coupler_forces(self) -> tuple[float, ...]:
        """Force in the coupler behind each car but the last, N; positive where it pulls."""
        return tuple(self._begun_stop().memory["couplers"]["force"].tolist())

    def result(self) -> tuple[evaluation.CaseResult, ...]:
        """Return the judged result of each car, as `uictest run` judges it; RuntimeError before the end."""
        return tuple(self._results())

    def recording(self) -> tuple[Recording, ...]:
        """Return the recording of each car; RuntimeError before the end of the stop or without `record`."""
        return self._recordings()
