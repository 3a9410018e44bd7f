"""Every stop passes here: it runs in this process, or in a child if its controller is from outside."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from threading import Lock
from types import TracebackType
from typing import Final, Self, TypeGuard

from uictest.controllers import ControllerError, ControllerProgram, ProgramKey
from uictest.rig.external.drives import DriveRequest, Drives, drive_controller
from uictest.rig.external.in_process import (
    BlockInputs,
    BlockRun,
    empty_exchange,
    empty_run,
    of_car,
    run_block,
    run_train_in_process,
)
from uictest.rig.external.worker import LARGEST_BLOCK, LostChildError, Worker
from uictest.rig.train_stop import FinishedStop, StopInputs, TrainInputs, TrainStop, alone

RunInputs = Callable[[StopInputs, int], FinishedStop]
"""Runs a stop, with so many base steps between two samples of its trace: here or in a child process."""


RunTrain = Callable[[TrainInputs, int], TrainStop]
"""Runs a stop of a train likewise."""


def in_real_time(run: RunInputs) -> RunInputs:
    """Return a function that runs a stop as `run` does, with cycles paced by the clock."""

    def run_in_real_time(inputs: StopInputs, steps_per_sample: int = 0) -> FinishedStop:
        if inputs.program is None:
            raise ValueError("a built-in controller is not paced by the clock")
        paced = replace(inputs.program, real_time=True)
        return run(inputs._replace(program=paced), steps_per_sample)

    return run_in_real_time


_MOST_IDLE: Final = 8
"""Children that are kept for the next stop of their program; chosen: each takes some 110 MB."""


class Workers:
    """Child processes, started when they are needed and kept until the end of the `with` block.

    A crash, a hang or a forbidden command of a controller ends its stop and, where it must, its process;
    other stops go on.

    Args:
        keep_output: whether what controllers print is part of their stops, in place of going to standard
            error.
    """

    def __init__(self, *, keep_output: bool = False) -> None:
        self._keep_output = keep_output
        self._idle: list[Worker] = []
        self._all: list[Worker] = []
        self._lock = Lock()
        self._closed = False

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def run(self, inputs: StopInputs, steps_per_sample: int = 0) -> FinishedStop:
        """Run a stop; one whose controller is built in, or a process of its own, runs here.

        Raises:
            ControllerError: when the controller cannot be opened, failed, crashed or did not answer in time.
        """
        [finished] = self.run_train(alone(inputs), steps_per_sample).cars
        return finished

    def run_train(self, inputs: TrainInputs, steps_per_sample: int = 0) -> TrainStop:
        """Run a stop of a train; one whose controllers are built in, or processes of their own, runs here.

        Raises:
            ControllerError: as :meth:`run`; the message names the car of a train of several.
        """
        programs = inputs.from_outside
        if not any(map(_is_isolated, programs.values())):
            return run_train_in_process(inputs, steps_per_sample)
        try:
            with self._worker(*programs.values()) as worker:
                stop = worker.run_train(inputs, steps_per_sample)
                output = worker.printed.taken()  # of all controllers, which one process runs
            cars = (
                replace(car, controller_output=output if index in programs else "")
                for index, car in enumerate(stop.cars)
            )
            return stop._replace(cars=tuple(cars))
        except LostChildError as error:
            if error.index is None:
                raise
            with of_car(list(programs)[error.index], inputs):
                raise

    def run_block(self, inputs: BlockInputs) -> BlockRun:
        """Run many stops; those whose controller is built in, or a process of its own, run here."""
        run = empty_run(len(inputs.programs))
        cases_of: dict[ProgramKey | None, list[int]] = {}
        for case, program in enumerate(inputs.programs):
            cases_of.setdefault(program.key if _is_isolated(program) else None, []).append(case)
        for key, cases in cases_of.items():
            if key is None:
                _copy_into(run, cases, run_block(inputs.at(cases)))
                continue
            for first in range(0, len(cases), LARGEST_BLOCK):
                self._run_isolated(inputs, cases[first : first + LARGEST_BLOCK], run)
        return run

    def drive(self, request: DriveRequest) -> Drives:
        """Drive a controller through given cycles. Raises ControllerError, as :meth:`run`."""
        if not _is_isolated(request.program):
            return drive_controller(request, empty_exchange())
        with self._worker(request.program) as worker:
            return worker.drive(request)

    def close(self) -> None:
        """End all child processes, also those in use."""
        with self._lock:
            self._closed = True
            workers, self._all, self._idle = self._all, [], []
        for worker in workers:
            worker.close()

    def _run_isolated(self, inputs: BlockInputs, cases: list[int], run: BlockRun) -> None:
        """Run some stops in a child; when it is lost, find the stop at fault and run the others again."""
        while cases:
            try:
                with self._worker(inputs.programs[cases[0]]) as worker:
                    _copy_into(run, cases, worker.run_block(inputs.at(cases)))
                return
            except LostChildError as error:
                if error.index is None and len(cases) > 1:
                    break
                run.failures[cases.pop(error.index or 0)] = f"controller: {error}"
        for case in cases:
            self._run_isolated(inputs, [case], run)

    @contextmanager
    def _worker(self, *programs: ControllerProgram | None) -> Iterator[Worker]:
        """Lend this thread a child for some programs."""
        worker = self._take_or_start(frozenset(each.key for each in programs if each is not None))
        try:
            yield worker
        except ControllerError as error:
            error.output = worker.printed.taken()
            raise
        finally:
            if not worker.usable:
                worker.close()
            with self._lock:
                if worker.usable:
                    self._idle.append(worker)
                elif worker in self._all:
                    self._all.remove(worker)

    def _take_or_start(self, keys: frozenset[ProgramKey]) -> Worker:
        with self._lock:
            if self._closed:
                raise RuntimeError("the child processes have been ended")
            for worker in reversed(self._idle):
                if worker.keys == keys:
                    self._idle.remove(worker)
                    return worker
            if len(self._idle) >= _MOST_IDLE:
                self._idle[0].close()
                self._all.remove(self._idle.pop(0))
            worker = Worker(keys, keep_output=self._keep_output)
            self._all.append(worker)
            return worker


def _is_isolated(program: ControllerProgram | None) -> TypeGuard[ControllerProgram]:
    return program is not None and program.kind != "connect"


def _copy_into(run: BlockRun, cases: Sequence[int], part: BlockRun) -> None:
    run.measures[cases], run.wheelset_measures[cases] = part.measures, part.wheelset_measures
    for case, failure in zip(cases, part.failures, strict=True):
        run.failures[case] = failure
