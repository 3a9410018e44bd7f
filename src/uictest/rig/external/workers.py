"""Every stop passes here: it runs in this process, or in a child if its controller is from outside."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from threading import Lock
from types import TracebackType
from typing import Final, Self, TypeGuard

from uictest.controllers import ControllerError, ControllerProgram, ProgramKey
from uictest.rig.external.block import BlockInputs, BlockRun, empty_run, run_block
from uictest.rig.external.drives import DriveRequest, Drives, drive_controller
from uictest.rig.external.in_process import empty_exchange, of_car, run_in_process, run_train_in_process
from uictest.rig.external.worker import LARGEST_BLOCK, LostChildError, Worker
from uictest.rig.single_stop import FinishedStop, StopInputs
from uictest.rig.train_stop import TrainInputs, TrainStop

RunInputs = Callable[[StopInputs, int], FinishedStop]
"""Runs a stop, with so many base steps between two samples of its trace: here or in a child process."""


RunTrain = Callable[[TrainInputs, int], TrainStop]
"""Runs a stop of a train likewise."""


def in_real_time(run: RunInputs) -> RunInputs:
    """Return what runs a stop as `run` does, its cycles paced by the clock."""

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
        if not _is_isolated(inputs.program):
            return run_in_process(inputs, steps_per_sample)
        with self._worker(inputs.program) as worker:
            return replace(worker.run(inputs, steps_per_sample), controller_output=worker.printed.taken())

    def run_train(self, inputs: TrainInputs, steps_per_sample: int = 0) -> TrainStop:
        """Run a stop of a train; one whose controllers are built in, or processes of their own, runs here.

        Raises:
            ControllerError: as :meth:`run`; the message names the car.
        """
        programs = inputs.from_outside
        if not any(map(_is_isolated, programs.values())):
            return run_train_in_process(inputs, steps_per_sample)
        try:
            with self._worker(*programs.values()) as worker:
                stop = worker.run_train(inputs, steps_per_sample)
                output = worker.printed.taken()  # of all controllers, which one process runs
            cars = (
                replace(car, controller_output=output if place in programs else "")
                for place, car in enumerate(stop.cars)
            )
            return stop._replace(cars=tuple(cars))
        except LostChildError as error:
            if error.place is None:
                raise
            car, program = list(programs.items())[error.place]
            with of_car(car, program):
                raise

    def run_block(self, inputs: BlockInputs) -> BlockRun:
        """Run many stops; those whose controller is built in, or a process of its own, run here."""
        places = range(len(inputs.programs))
        here = [place for place in places if not _is_isolated(inputs.programs[place])]
        run = empty_run(len(places))
        if here:
            _put(run, here, run_block(inputs.at(here)))
        for there in _places_by_program(inputs.programs):
            for first in range(0, len(there), LARGEST_BLOCK):
                self._run_isolated(inputs, there[first : first + LARGEST_BLOCK], run)
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

    def _run_isolated(self, inputs: BlockInputs, places: list[int], run: BlockRun) -> None:
        """Run some stops in a child; when it is lost, find the stop at fault and run the others again."""
        while places:
            try:
                with self._worker(inputs.programs[places[0]]) as worker:
                    _put(run, places, worker.run_block(inputs.at(places)))
                return
            except LostChildError as error:
                if error.place is None and len(places) > 1:
                    break
                run.failures[places.pop(error.place or 0)] = f"controller: {error}"
        for place in places:
            self._run_isolated(inputs, [place], run)

    @contextmanager
    def _worker(self, *programs: ControllerProgram | None) -> Iterator[Worker]:
        """Lend this thread a child for some programs."""
        worker = self._taken(frozenset(each.key for each in programs if each is not None))
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

    def _taken(self, keys: frozenset[ProgramKey]) -> Worker:
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


def _places_by_program(programs: Sequence[ControllerProgram | None]) -> Iterable[list[int]]:
    """Return the places of the stops that run in children, those of a program together."""
    places: dict[ProgramKey, list[int]] = {}
    for place, program in enumerate(programs):
        if _is_isolated(program):
            places.setdefault(program.key, []).append(place)
    return places.values()


def _put(run: BlockRun, places: Sequence[int], part: BlockRun) -> None:
    """Enter what some of the stops have left."""
    run.measures[places], run.wheelset_measures[places] = part.measures, part.wheelset_measures
    for place, failure in zip(places, part.failures, strict=True):
        run.failures[place] = failure
