"""From the file of an FMU to an instance of it: FMPy's slaves of FMI 2.0 and FMI 3.0 with one interface.

FMPy calls the functions and raises where they fail. What it leaves to its caller stands here: which files may
be loaded, what a user is told, what the FMU has logged, and when an instance is used again or released.
"""

import io
import math
import os
import re
import weakref
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from ctypes import byref, c_int
from importlib import import_module
from itertools import count
from pathlib import Path
from threading import Lock, local
from typing import Any, Final, NamedTuple
from zipfile import BadZipFile, ZipFile

import fmpy
from fmpy import fmi1, fmi2, fmi3

from uictest.controllers.adapters.instance import ControllerError, reason_of, unchanged_content
from uictest.core import files

_VERSIONS: Final = ("2.0", "3.0")
_LARGEST_REFERENCE: Final = 2**32 - 1
_C_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
LARGEST: Final = 2**30
"""Most bytes that an FMU may have unpacked; chosen: FMUs with their resources have some megabytes."""
_STATUS: Final = ("ok", "warning", "discard", "error", "fatal", "pending")
_FATAL: Final = 4
_TOLERANCE: Final = 1e-6  # of a step size as a share: decimal fractions are not exact
_TYPES: Final[dict[bool, dict[str, str]]] = {
    True: {each: each for each in ("Real", "Integer", "Boolean", "String")} | {"Enumeration": "Integer"},
    False: {
        **{each: each for each in ("Float32", "Float64", "Boolean", "String")},
        **{each: each for bits in (8, 16, 32, 64) for each in (f"Int{bits}", f"UInt{bits}")},
        "Enumeration": "Int64",
    },
}
"""Whether it is FMI 2.0 -> type of a variable -> its name in functions."""


class UnpackedFmu(NamedTuple):
    """A temporary folder with the content of an FMU, and its model description as FMPy reads it."""

    folder: Path
    description: Any


def unpack(content: bytes) -> UnpackedFmu:
    """Unpack an FMU into a temporary folder. Raises ControllerError where it cannot be run here."""
    folder = files.new_temporary_folder("fmu")
    try:
        _extract(content, folder)
        try:
            # Many tools' files break a rule of the schema that nothing here depends on.
            description = fmpy.read_model_description(folder, validate=False)
        except Exception as error:
            raise ControllerError(
                f"has a modelDescription.xml that cannot be read: {reason_of(error)}"
            ) from error
        _check(folder, description)
    except BaseException:
        files.remove_temporary_folder(folder)
        raise
    return UnpackedFmu(folder, description)


def _extract(content: bytes, folder: Path) -> None:
    try:
        with ZipFile(io.BytesIO(content)) as archive:
            size = sum(each.file_size for each in archive.infolist())
        if size <= LARGEST:
            fmpy.extract(io.BytesIO(content), folder)
    except BadZipFile:
        raise ControllerError("is no FMU: it is not a ZIP archive, or a damaged one") from None
    except Exception as error:
        raise ControllerError(f"cannot be unpacked: {reason_of(error)}") from error
    if size > LARGEST:
        raise ControllerError(f"has {size:,} bytes unpacked, at most {LARGEST:,} are accepted")
    if not (folder / "modelDescription.xml").is_file():
        raise ControllerError("is no FMU: it has no modelDescription.xml")


def _check(folder: Path, description: Any) -> None:
    """Raise ControllerError unless it is for co-simulation, of a known version and for this machine."""
    if not description.fmiVersion.startswith(_VERSIONS):
        raise ControllerError(f"is an FMU of FMI {description.fmiVersion}, expected {' or '.join(_VERSIONS)}")
    if description.coSimulation is None:
        raise ControllerError("is an FMU without co-simulation: export it for co-simulation")
    for each in description.modelVariables:
        if not 0 <= each.valueReference <= _LARGEST_REFERENCE:
            found = f"value reference {each.valueReference} of {each.name}"
            raise ControllerError(f"has {found}, expected a number from 0 to {_LARGEST_REFERENCE}")
    platform = fmpy.platform if description.fmiVersion == "2.0" else fmpy.platform_tuple
    identifier = str(description.coSimulation.modelIdentifier)
    if not _C_NAME.fullmatch(identifier):
        raise ControllerError(
            f"has modelIdentifier {identifier!r}, expected a name of C: it names the library"
        )
    binary = f"{identifier}{fmpy.sharedLibraryExtension}"
    library = folder / "binaries" / platform / binary
    if not (library.is_file() and library.resolve().is_relative_to(folder.resolve())):
        platforms = ", ".join(sorted(each.name for each in folder.glob("binaries/*") if each.is_dir()))
        found = f"only for {platforms}" if platforms else "for no platform"
        raise ControllerError(f"is built {found}, expected {platform} with {binary}")


class _Log(local):
    """The last message of the FMUs of a thread that is not only information."""

    message = ""

    def after(self, text: str) -> str:
        """Return a text, followed by what the FMU has logged last."""
        return f"{text}: {self.message}" if self.message else text


_log = _Log()


def _note(status: int, message: bytes | None) -> None:
    if status > 0:
        _log.message = (message or b"").decode("utf-8", "replace").strip()


def _fmi2_callbacks() -> Any:
    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(
        lambda environment, instance, status, category, message: _note(status, message)
    )
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.free)
    with suppress(OSError):  # FMPy has it for some platforms; without it messages keep their placeholders
        import_module("fmpy.logging").addLoggerProxy(byref(callbacks))
    return callbacks


_FMI2_CALLBACKS: Final = _fmi2_callbacks()
"""What FMUs of FMI 2.0 call. FMPy formats messages for one logger only, so there is one for all FMUs."""
_loading: Final = Lock()
_numbers: Final = count(1)
"""Of instances, part of their names: the standards ask for names that are unique."""


class Slave:
    """An FMU, instantiated for co-simulation; FMPy's slave does the calls."""

    def __init__(self, unpacked: UnpackedFmu) -> None:
        self._unpacked = unpacked
        self.description = unpacked.description
        self._is_fmi2 = unpacked.description.fmiVersion == "2.0"
        self.types = _TYPES[self._is_fmi2]
        """Types of variables, and the name of each in functions."""
        self._instantiate()

    def _instantiate(self) -> None:
        self._fmu = _instantiated(*self._unpacked)
        self._started, self.usable = False, True
        """`usable`: False once a call has failed."""
        self.release = weakref.finalize(self, _release, self._fmu, self._unpacked.folder)
        """Free the instance, unload the library and remove its folder; at the latest when Python ends."""

    @contextmanager
    def checked(self) -> Iterator[None]:
        """Turn failed calls into ControllerError."""
        _log.message = ""
        try:
            yield
        except fmi1.FMICallException as error:
            self._note_failure(error)
            status = _STATUS[error.status] if error.status < len(_STATUS) else error.status
            raise ControllerError(_log.after(f"{error.function} returned {status}")) from error

    def _note_failure(self, error: Any) -> None:
        self.usable = False
        if error.status == _FATAL:  # the standard forbids any further call
            self._fmu.component = None

    def check_step_size(self, cycle_time: float) -> None:
        """Raise ControllerError if the FMU cannot make steps of one cycle, s."""
        interface, experiment = self.description.coSimulation, self.description.defaultExperiment
        if self._is_fmi2:
            stated = (experiment.stepSize or None) if experiment is not None else None
        else:
            stated = interface.fixedInternalStepSize
        if stated is None:
            return
        try:
            size = float(stated)
        except ValueError:
            size = math.nan
        if not 0.0 < size < math.inf:
            raise ControllerError("states a step size that is none: expected a number of seconds above 0")
        steps = cycle_time / size
        fits = round(steps) >= 1 and abs(steps / round(steps) - 1.0) <= _TOLERANCE
        if not (fits or interface.canHandleVariableCommunicationStepSize):
            raise ControllerError(
                f"makes steps of {size:g} s: cycle_time is {cycle_time:g} s, expected a multiple of it"
            )

    def reset(self) -> None:
        """Return to the state after instantiation."""
        try:
            if self._started:
                self._fmu.reset()
        except fmi1.FMICallException as error:
            # Some tools' FMUs cannot be reset, though the standards ask for it: another instance can begin.
            self._note_failure(error)
            _free(self._fmu)
            release = self.release
            self._instantiate()
            release.detach()
        self._started = True
        if self._is_fmi2:
            self._fmu.setupExperiment(startTime=0.0)

    @contextmanager
    def initialising(self) -> Iterator[None]:
        """Initialise at time 0; afterwards it is ready for the first step."""
        self._fmu.enterInitializationMode()
        yield
        self._fmu.exitInitializationMode()

    def step(self, time: float, size: float) -> None:
        """Make one step of some size from some time, s."""
        done = self._fmu.doStep(time, size)
        if not self._is_fmi2 and done[1]:
            raise ControllerError("the FMU asks to end the simulation")

    def set(self, kind: str, references: Sequence[int], values: Sequence[Any]) -> None:
        """Set variables of one type, named as in functions, by their value references."""
        getattr(self._fmu, f"set{kind}")(references, values)

    def get(self, kind: str, references: Sequence[int], count: int) -> Sequence[Any]:
        """Return so many values of variables of one type."""
        values: Sequence[Any] = getattr(self._fmu, f"get{kind}")(
            references, *(() if self._is_fmi2 else (count,))
        )
        return values

    def holds(self, kind: str, value: float) -> bool:
        """Return whether a type of whole numbers, named as in functions, has a value."""
        c_type = c_int if self._is_fmi2 else getattr(fmi3, f"fmi3{kind}")
        return float(value).is_integer() and bool(c_type(int(value)).value == value)


def load_slave(path: Path, sha256: str) -> Slave:
    """Unpack an FMU, load its library and instantiate it. Raises ControllerError."""
    content = unchanged_content(path, sha256)
    try:
        unpacked = unpack(content)
        try:
            return Slave(unpacked)
        except BaseException:
            files.remove_temporary_folder(unpacked.folder)
            raise
    except ControllerError as error:
        raise ControllerError(f"{path.name} {error}") from error


def _instantiated(folder: Path, description: Any) -> Any:
    is_fmi2, interface = description.fmiVersion == "2.0", description.coSimulation
    kind = fmi2.FMU2Slave if is_fmi2 else fmi3.FMU3Slave
    with _loading:  # FMPy changes the working folder to load a library
        working_folder = Path.cwd()
        try:
            fmu = kind(
                guid=description.guid,
                unzipDirectory=str(folder),
                modelIdentifier=interface.modelIdentifier,
                instanceName=f"{interface.modelIdentifier}_{next(_numbers)}",
            )
        except Exception as error:
            reason = str(error).replace(f"{folder}{os.sep}", "")
            raise ControllerError(f"cannot be loaded: {reason}") from error
        finally:
            os.chdir(working_folder)
    _log.message = ""
    try:
        if is_fmi2:
            fmu.instantiate(callbacks=_FMI2_CALLBACKS)
        else:
            fmu.instantiate(logMessage=lambda environment, status, category, text: _note(status, text))
    except Exception as error:
        fmu.freeLibrary()
        tool = description.generationTool or "not named"
        needs = f" (it needs its tool on this machine: {tool})" if interface.needsExecutionTool else ""
        raise ControllerError(_log.after(f"cannot be instantiated{needs}")) from error
    return fmu


def _release(fmu: Any, folder: Path) -> None:
    _free(fmu)
    files.remove_temporary_folder(folder)


def _free(fmu: Any) -> None:
    if fmu.component:
        for end in (fmu.terminate, fmu.freeInstance):
            with suppress(Exception):
                end()
        fmu.component = None
