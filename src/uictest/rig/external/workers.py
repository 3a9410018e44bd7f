"""Every stop passes here: it runs in this process, or in a child if its controller is from outside."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from threading import Lock
from types import TracebackType
from typing import Final, Self, TypeGuard

from uictest.controllers import ControllerProgram
from uictest.rig.backends.native import compiled_stop
from uictest.rig.external.block import BlockInputs, BlockRun, empty_run, load_block, run_block
from uictest.rig.external.in_process import (
    DriveRequest,
    Drives,
    drive_controller,
    empty_exchange,
    run_in_process,
)
from uictest.rig.external.worker import LARGEST_BLOCK, LostChildError, ProgramKey, Worker
from uictest.rig.single_stop import FinishedStop, StopInputs

RunInputs = Callable[[StopInputs, int], FinishedStop]
"""Runs a stop, with so many base steps between two samples of its trace: here or in a child process."""


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
    """

    def __init__(self) -> None:
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
        compiled_stop()  # so that the child finds it in the cache
        with self._worker(_key(inputs.program)) as worker:
            return worker.run(inputs, steps_per_sample)

    def run_block(self, inputs: BlockInputs) -> BlockRun:
        """Run many stops; those whose controller is built in, or a process of its own, run here."""
        places = range(len(inputs.programs))
        here = [place for place in places if not _is_isolated(inputs.programs[place])]
        load_block(inputs.programs)  # so that the child finds it in the cache
        run = empty_run(len(places))
        if here:
            _put(run, here, run_block(inputs.at(here)))
        for key, there in _places_by_program(inputs.programs).items():
            for first in range(0, len(there), LARGEST_BLOCK):
                self._run_isolated(key, inputs, there[first : first + LARGEST_BLOCK], run)
        return run

    def drive(self, request: DriveRequest) -> Drives:
        """Drive a controller through given cycles. Raises ControllerError, as :meth:`run`."""
        if not _is_isolated(request.program):
            return drive_controller(request, empty_exchange())
        with self._worker(_key(request.program)) as worker:
            return worker.drive(request)

    def close(self) -> None:
        """End all child processes, also those in use."""
        with self._lock:
            self._closed = True
            workers, self._all, self._idle = self._all, [], []
        for worker in workers:
            worker.close()

    def _run_isolated(self, key: ProgramKey, inputs: BlockInputs, places: list[int], run: BlockRun) -> None:
        """Run some stops in a child; when it is lost, find the stop at fault and run the others again."""
        while places:
            try:
                with self._worker(key) as worker:
                    _put(run, places, worker.run_block(inputs.at(places)))
                return
            except LostChildError as error:
                if error.place is None and len(places) > 1:
                    break
                run.failures[places.pop(error.place or 0)] = f"controller: {error}"
        for place in places:
            self._run_isolated(key, inputs, [place], run)

    @contextmanager
    def _worker(self, key: ProgramKey) -> Iterator[Worker]:
        """Lend this thread a child for a program."""
        worker = self._taken(key)
        try:
            yield worker
        finally:
            if not worker.usable:
                worker.close()
            with self._lock:
                if worker.usable:
                    self._idle.append(worker)
                elif worker in self._all:
                    self._all.remove(worker)

    def _taken(self, key: ProgramKey) -> Worker:
        with self._lock:
            if self._closed:
                raise RuntimeError("the child processes have been ended")
            for worker in reversed(self._idle):
                if worker.key == key:
                    self._idle.remove(worker)
                    return worker
            if len(self._idle) >= _MOST_IDLE:
                self._idle[0].close()
                self._all.remove(self._idle.pop(0))
            worker = Worker(key)
            self._all.append(worker)
            return worker


def _is_isolated(program: ControllerProgram | None) -> TypeGuard[ControllerProgram]:
    return program is not None and program.kind != "connect"


def _key(program: ControllerProgram) -> ProgramKey:
    return program.kind, program.location, program.sha256


def _places_by_program(programs: Sequence[ControllerProgram | None]) -> dict[ProgramKey, list[int]]:
    """Return the places of the stops that run in children, those of a program together."""
    places: dict[ProgramKey, list[int]] = {}
    for place, program in enumerate(programs):
        if _is_isolated(program):
            places.setdefault(_key(program), []).append(place)
    return places


def _put(run: BlockRun, places: Sequence[int], part: BlockRun) -> None:
    """Enter what some of the stops have left."""
    run.measures[places], run.wheelset_measures[places] = part.measures, part.wheelset_measures
    for place, failure in zip(places, part.failures, strict=True):
        run.failures[place] = failure
