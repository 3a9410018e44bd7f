"""An FMU in memory: the calls of FMI 2.0 and FMI 3.0 behind one face, and what it logs."""

import math
import weakref
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from ctypes import byref, c_bool, c_char_p, c_double, c_int
from functools import partial
from importlib import import_module
from pathlib import Path
from threading import local
from typing import Any, ClassVar, Final

import fmpy
from fmpy import fmi1, fmi2, fmi3

from uictest.controllers.adapters.instance import ControllerError
from uictest.core import files


class _Log(local):
    """The last message of the FMUs of a thread that is not only information."""

    message = ""


_log = _Log()


def clear_log() -> None:
    """Forget what was logged before a call."""
    _log.message = ""


def with_log(text: str) -> str:
    """Return a text, followed by what the FMU has logged last."""
    return f"{text}: {_log.message}" if _log.message else text


def _note(status: int, message: bytes | None) -> None:
    if status > 0:
        _log.message = (message or b"").decode("utf-8", "replace").strip()


def _note_fmi2(environment: Any, instance: bytes, status: int, category: bytes, message: bytes) -> None:
    _note(status, message)


def note_fmi3(environment: Any, status: int, category: bytes, message: bytes) -> None:
    """Keep a message; FMI 3.0 calls this."""
    _note(status, message)


def _callbacks() -> Any:
    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(_note_fmi2)
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.free)
    with suppress(OSError):  # FMPy has it for some platforms; without it messages keep their placeholders
        import_module("fmpy.logging").addLoggerProxy(byref(callbacks))
    return callbacks


FMI2_CALLBACKS: Final = _callbacks()
"""What FMUs of FMI 2.0 call. FMPy formats messages for one logger only, so there is one for all FMUs."""


CType = Any
_STATUS: Final = ("ok", "warning", "discard", "error", "fatal", "pending")
_FATAL: Final = 4
_TOLERANCE: Final = 1e-6  # of a step size as a share: decimal fractions are not exact
_NUMBERS: Final = (
    "Float32",
    "Float64",
    *(f"{sign}Int{bits}" for bits in (8, 16, 32, 64) for sign in ("", "U")),
)


class Slave(ABC):
    """An FMU, instantiated for co-simulation."""

    types: ClassVar[Mapping[str, tuple[str, CType]]]
    """Type of a variable -> its name in functions, its C type."""

    def __init__(self, fmu: Any, description: Any, folder: Path) -> None:
        self.description = description
        self.usable = True
        """False once a call has failed."""
        self._fmu = fmu
        self._started = False
        self.release = weakref.finalize(self, _release, fmu, folder)
        """Free the instance, unload the library and remove its folder; at the latest when Python ends."""

    @contextmanager
    def checked(self) -> Iterator[None]:
        """Turn failed calls into ControllerError."""
        clear_log()
        try:
            yield
        except fmi1.FMICallException as error:
            self.usable = False
            if error.status == _FATAL:  # the standard forbids any further call
                self._fmu.component = None
            status = _STATUS[error.status] if error.status < len(_STATUS) else error.status
            raise ControllerError(with_log(f"{error.function} returned {status}")) from error

    def check_step_size(self, cycle_time: float) -> None:
        """Raise ControllerError if the FMU cannot make steps of one cycle, s."""
        try:
            size = self._only_step_size()
        except ValueError:
            size = math.nan
        if size is not None and not 0.0 < size < math.inf:
            raise ControllerError("states a step size that is none: expected a number of seconds above 0")
        if size is None or self.description.coSimulation.canHandleVariableCommunicationStepSize:
            return
        steps = cycle_time / size
        if round(steps) < 1 or abs(steps / round(steps) - 1.0) > _TOLERANCE:
            raise ControllerError(
                f"makes steps of {size:g} s: cycle_time is {cycle_time:g} s, expected a multiple of it"
            )

    def reset(self) -> None:
        """Return to the state after instantiation."""
        if self._started:
            self._fmu.reset()
        self._started = True

    def exit_initialisation(self) -> None:
        """Be ready for the first step."""
        self._fmu.exitInitializationMode()

    @abstractmethod
    def enter_initialisation(self) -> None:
        """Begin to initialise at time 0."""

    @abstractmethod
    def step(self, time: float, size: float) -> None:
        """Make one step of some size from some time, s."""

    @abstractmethod
    def access(self, verb: str, kind: str, references: Any, values: Any) -> Callable[[], object]:
        """Return what sets (``Set``) or reads (``Get``) variables of one type, by their value references."""

    @abstractmethod
    def _only_step_size(self) -> float | None:
        """Return the step size that the FMU was built for, s, None if it does not say."""


class Fmi2Slave(Slave):
    """An FMU of FMI 2.0."""

    types: ClassVar = {
        "Real": ("Real", c_double),
        "Integer": ("Integer", c_int),
        "Enumeration": ("Integer", c_int),
        "Boolean": ("Boolean", c_int),
        "String": ("String", c_char_p),
    }

    def reset(self) -> None:
        """Return to the state after instantiation."""
        super().reset()
        self._fmu.setupExperiment(startTime=0.0)

    def enter_initialisation(self) -> None:
        """Begin to initialise at time 0."""
        self._fmu.enterInitializationMode()

    def step(self, time: float, size: float) -> None:
        """Make one step of some size from some time, s."""
        self._fmu.doStep(time, size)

    def access(self, verb: str, kind: str, references: Any, values: Any) -> Callable[[], object]:
        """Return what sets or reads variables of one type."""
        call = getattr(self._fmu, f"fmi2{verb}{kind}")
        return partial(call, self._fmu.component, references, len(references), values)

    def _only_step_size(self) -> float | None:
        experiment = self.description.defaultExperiment
        return float(experiment.stepSize) if experiment is not None and experiment.stepSize else None


class Fmi3Slave(Slave):
    """An FMU of FMI 3.0."""

    types: ClassVar = {
        **{name: (name, getattr(fmi3, f"fmi3{name}")) for name in _NUMBERS},
        "Enumeration": ("Int64", fmi3.fmi3Int64),
        "Boolean": ("Boolean", c_bool),
        "String": ("String", c_char_p),
    }

    def enter_initialisation(self) -> None:
        """Begin to initialise at time 0."""
        self._fmu.enterInitializationMode(startTime=0.0)

    def step(self, time: float, size: float) -> None:
        """Make one step of some size from some time, s."""
        _, terminate, _, _ = self._fmu.doStep(time, size)
        if terminate:
            raise ControllerError("the FMU asks to end the simulation")

    def access(self, verb: str, kind: str, references: Any, values: Any) -> Callable[[], object]:
        """Return what sets or reads variables of one type."""
        call = getattr(self._fmu, f"fmi3{verb}{kind}")
        return partial(call, self._fmu.component, references, len(references), values, len(values))

    def _only_step_size(self) -> float | None:
        size = self.description.coSimulation.fixedInternalStepSize
        return None if size is None else float(size)


def _release(fmu: Any, folder: Path) -> None:
    if fmu.component:
        with suppress(Exception):
            fmu.terminate()
        with suppress(Exception):
            fmu.freeInstance()
    files.remove_temporary_folder(folder)
