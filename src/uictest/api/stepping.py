"""The rig of a car alone as a Python object: reset it, step it, look at its true state."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from uictest import rig
from uictest.api.stepped_rig import (
    RigState,
    SteppedRig,
    loaded,
    reject_failure,
    state_of,
    write_commands,
)
from uictest.controllers import Inputs, Outputs, read_inputs
from uictest.core.recording import Recording
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.rig import SteppedTrain, alone, assemble, bench, noise_key_text
from uictest.running import campaign

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
        super().__init__(record, contract)
        cases = loaded(path, trust)
        only_trains = case is None and all(each.train for each in cases)
        chosen = cases[0] if only_trains else scenario.chosen_case(cases, case)
        if chosen.train is not None:
            raise ValueError(f"{chosen.id} is {chosen.train.label}: step its train with uictest.TrainRig")
        self.case = bench.identified(chosen.changed(scenario.with_another_controller))
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

        Raises ValueError for another seed.
        """
        self._inputs = inputs = assemble(self.case)
        self._noise_key = noise_key_text(inputs.parameters)
        every = self._begin(inputs.parameters, seed)
        self._stop = SteppedTrain(alone(inputs), every)
        return read_inputs(self._stop.inputs[0])

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
        write_commands(stop.outputs[0], outputs, self._contract)
        stop.step()
        reject_failure(stop.memory["exchange"][0])
        return read_inputs(stop.inputs[0])

    @property
    def state(self) -> RigState:
        """The true state at present. Raises RuntimeError before :meth:`reset`."""
        return state_of(self._begun().memory)

    def result(self) -> evaluation.CaseResult:
        """Return the judged result of the stop, as `uictest run` judges it; RuntimeError before its end."""
        [finished] = self._ended().finished()
        measures = rig.measures_with_reference(finished.measures, self._inputs)
        result = evaluation.evaluate_simulated(self.case, measures, finished.wheelset_measures)
        [whole] = campaign.with_rails([self._seeded(self.case)], [self._stated(result, self._noise_key)])
        return whole

    def recording(self) -> Recording:
        """Return the recording of the stop; RuntimeError before its end or without `record`."""
        return self._recording(self.case, self._recorded().finished()[0])
