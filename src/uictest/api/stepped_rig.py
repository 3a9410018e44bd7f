"""What the rigs that a program steps have in common: the state they show, arguments, commands, results."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from numbers import Real
from operator import index
from pathlib import Path
from typing import Any, Final

from uictest.controllers import CONTRACTS, NO_REDUCTION, NO_REFERENCE, ControllerError, Outputs, write_outputs
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import library, scenario
from uictest.rig import FinishedStop, SteppedTrain, check_requests, recording_of_stop

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


_LARGEST_SEED: Final = 2**32 - 1


class SteppedRig:
    """What the rig of a car and that of a train have in common."""

    def __init__(self, record: float | None, contract: int) -> None:
        """Check the arguments of a rig; :class:`Rig` explains them. Raises ValueError."""
        if _whole(contract) not in CONTRACTS:
            raise ValueError(f"contract is {contract!r}, expected {' or '.join(map(str, CONTRACTS))}")
        if record is not None and not (isinstance(record, Real) and 0.0 < record < math.inf):
            raise ValueError(f"record is {record!r}, expected samples per second or None")
        self._record = record
        self._contract = contract
        self._stop: SteppedTrain | None = None
        self._seed: int | None = None

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
        try:
            check_requests(self._contract, parameters)
        except ControllerError as error:
            raise ValueError(f"{error}: create the rig with contract=2") from None
        parameters["controller_contract"] = self._contract
        self._seed = None if seed is None else _checked_seed(seed)
        if self._seed is not None:
            parameters["seed"] = self._seed
        step = float(parameters["step"].flat[0])
        return 0 if self._record is None else max(round(1.0 / (self._record * step)), 1)

    def _begun(self) -> SteppedTrain:
        if self._stop is None:
            raise RuntimeError("no stop has begun: call reset() first")
        return self._stop

    def _running(self) -> SteppedTrain:
        stop = self._begun()
        if stop.has_ended:
            raise RuntimeError(f"the stop has ended after {stop.time:g} s: call reset()")
        return stop

    def _ended(self) -> SteppedTrain:
        stop = self._begun()
        if not stop.has_ended:
            raise RuntimeError(f"the stop has not ended after {stop.time:g} s: call step()")
        return stop

    @property
    def _given_seed(self) -> dict[str, str]:
        """What results and recordings state of the seed, where it is not the scenario's."""
        return {} if self._seed is None else {"seed": str(self._seed)}

    def _seeded(self, case: scenario.Case) -> scenario.Case:
        """Return a case with the seed that its stop was begun with."""
        return case if self._seed is None else case.with_values(seed=self._seed)

    def _stated(self, result: evaluation.CaseResult, noise_key: str) -> evaluation.CaseResult:
        """Return a result that names the contract and the noise of its stop."""
        parameters = {**result.parameters, **self._given_seed}
        return replace(result, controller_contract=self._contract, noise_key=noise_key, parameters=parameters)

    def _recording(self, case: scenario.Case, finished: FinishedStop) -> Recording:
        found = recording_of_stop(case, replace(finished, contract=self._contract), from_outside=True)
        return replace(found, metadata={**found.metadata, **self._given_seed})

    def _recorded(self) -> SteppedTrain:
        if self._record is None:
            raise RuntimeError("nothing was recorded: create the rig with record=100 (samples per second)")
        return self._ended()


def loaded(path: str | Path, trust: Iterable[str | Path]) -> list[scenario.Case]:
    """Return the cases of a scenario file, or of one that ships."""
    place = library.named_scenario(Path(path))
    return scenario.load([place], trusted=[Path(folder) for folder in trust])


def _checked_seed(seed: int) -> int:
    number = _whole(seed)
    if number is None or not 0 <= number <= _LARGEST_SEED:
        raise ValueError(f"seed is {seed!r}, expected a whole number from 0 to {_LARGEST_SEED}")
    return number


def _whole(value: Any) -> int | None:
    """Return a whole number, of numpy, too; None for all else."""
    return None if isinstance(value, bool) or not hasattr(value, "__index__") else index(value)


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
        if failure == NO_REFERENCE:
            raise ValueError(f"reference_speed is {exchange['reference_speed']}, expected a number or NaN")
        raise ValueError(
            f"vent[{place}] is 1 and hold[{place}] is 0, which is forbidden: both are 1 in order to vent"
        )
