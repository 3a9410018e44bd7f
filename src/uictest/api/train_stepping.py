"""The rig of a train as a Python object: one controller per car, all stepped together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from uictest.api.stepped_rig import RigState, SteppedRig, loaded, reject_failure, state_of, write_commands
from uictest.controllers import Inputs, Outputs, read_inputs
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import (
    FinishedStop,
    SteppedTrain,
    assemble,
    assemble_train,
    bench,
    coupling_of,
    measures_with_reference,
    noise_key_text,
    peaks_beside,
)
from uictest.running import campaign


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
        super().__init__(record, contract)
        cars = scenario.chosen_train(loaded(path, trust), case)
        self.cases = tuple(bench.identified(car.changed(scenario.with_another_controller)) for car in cars)
        self._noise_keys: tuple[str, ...] = ()

    @property
    def cycle_time(self) -> float:
        """Time from one step to the next, s."""
        return float(self.cases[0].scenario.controller.cycle_time)

    def reset(self, seed: int | None = None) -> tuple[Inputs, ...]:
        """Begin a stop and return what the sensors of each car show; as :meth:`uictest.Rig.reset`."""
        cars = self.cases[0].cars
        train = assemble_train(cars, coupling_of(cars[0].scenario))
        self._noise_keys = tuple(noise_key_text(each) for each in train.parameters)
        self._stop = SteppedTrain(train, self._begin(train.parameters, seed))
        return tuple(map(read_inputs, self._stop.inputs))

    def step(self, outputs: Sequence[Outputs]) -> tuple[Inputs, ...]:
        """Carry out the commands for one controller cycle and return what the sensors show at its end.

        Args:
            outputs: the commands for each car; also of one that stands, until all cars stand.

        Raises:
            RuntimeError: before :meth:`reset`, or after the end of the stop.
            ValueError: commands that no valve can carry out, the message names the car; no car moves.
        """
        stop = self._running()
        if not isinstance(outputs, Sequence):
            raise ValueError(f"outputs is {type(outputs).__name__}, expected a list, one for each car")
        if len(outputs) != len(self.cases):
            raise ValueError(f"{len(outputs)} outputs, expected one for each of {len(self.cases)} cars")
        for number, (record, own) in enumerate(zip(stop.outputs, outputs, strict=True), start=1):
            with _named(number):
                write_commands(record, own, self._contract)
        stop.step()
        for number, exchange in enumerate(stop.memory["exchange"], start=1):
            with _named(number):
                reject_failure(exchange)
        return tuple(map(read_inputs, stop.inputs))

    @property
    def state(self) -> tuple[RigState, ...]:
        """The true state of each car at present. Raises RuntimeError before :meth:`reset`."""
        memory = self._begun().memory
        return tuple(state_of(memory, car) for car in range(len(self.cases)))

    @property
    def coupler_forces(self) -> tuple[float, ...]:
        """Force in the coupler behind each car but the last, N; positive where it pulls."""
        return tuple(self._begun().memory["couplers"]["force"].tolist())

    def result(self) -> tuple[evaluation.CaseResult, ...]:
        """Return the judged result of each car, as `uictest run` judges it; RuntimeError before the end."""
        stop = self._ended()
        each_car = zip(
            *(self.cases, stop.finished(), peaks_beside(stop.memory["couplers"]), self._noise_keys),
            strict=True,
        )
        results = [
            self._stated(
                evaluation.evaluate_simulated(
                    car, self._measures(car, finished), finished.wheelset_measures, couplers=couplers
                ),
                noise_key,
            )
            for car, finished, couplers, noise_key in each_car
        ]
        return tuple(campaign.with_rails([self._seeded(car) for car in self.cases], results))

    def _measures(self, car: scenario.Case, finished: FinishedStop) -> Any:
        """Return the measures of a car, which has a reference where it is a car alone."""
        if car.train is not None:
            return finished.measures
        return measures_with_reference(finished.measures, assemble(self._seeded(car)))

    def recording(self) -> tuple[Recording, ...]:
        """Return the recording of each car; RuntimeError before the end of the stop or without `record`."""
        return tuple(
            self._recording(car, finished)
            for car, finished in zip(self.cases, self._recorded().finished(), strict=True)
        )


@contextmanager
def _named(number: int) -> Iterator[None]:
    """Let an error name the car that it is of."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"car {number}: {error}") from None
