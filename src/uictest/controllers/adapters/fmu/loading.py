"""From the file of an FMU to an instance of it."""

import hashlib
import io
import os
import re
from pathlib import Path
from threading import Lock
from typing import Any, Final, NamedTuple
from zipfile import BadZipFile, ZipFile

import fmpy
from fmpy import fmi2, fmi3

from uictest.controllers.adapters.fmu.slave import (
    FMI2_CALLBACKS,
    Fmi2Slave,
    Fmi3Slave,
    Slave,
    clear_log,
    note_fmi3,
    with_log,
)
from uictest.controllers.adapters.instance import ControllerError, reason_of
from uictest.core import files

_VERSIONS: Final = ("2.0", "3.0")
_LARGEST_REFERENCE: Final = 2**32 - 1
_C_NAME: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
LARGEST: Final = 2**30
"""Most bytes that an FMU may have unpacked; chosen: FMUs with their resources have some megabytes."""


class UnpackedFmu(NamedTuple):
    """A temporary folder with the content of an FMU, and its model description as FMPy reads it."""

    folder: Path
    description: Any


def unpack(path: Path, sha256: str) -> UnpackedFmu:
    """Unpack an FMU into a temporary folder. Raises ControllerError where it cannot be run here."""
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != sha256:
        raise ControllerError("has changed since the scenario was read")
    folder = files.new_temporary_folder("fmu")
    try:
        _extract(content, folder)
        description = _description(folder)
        _check(folder, description)
    except BaseException:
        files.remove_temporary_folder(folder)
        raise
    return UnpackedFmu(folder, description)


def _extract(content: bytes, folder: Path) -> None:
    try:
        with ZipFile(io.BytesIO(content)) as archive:
            size = sum(each.file_size for each in archive.infolist())
        if size > LARGEST:
            raise ControllerError(f"has {size:,} bytes unpacked, at most {LARGEST:,} are accepted")
        fmpy.extract(io.BytesIO(content), folder)
    except ControllerError:
        raise
    except BadZipFile:
        raise ControllerError("is no FMU: it is not a ZIP archive, or a damaged one") from None
    except Exception as error:
        raise ControllerError(f"cannot be unpacked: {reason_of(error)}") from error
    if not (folder / "modelDescription.xml").is_file():
        raise ControllerError("is no FMU: it has no modelDescription.xml")


def _description(folder: Path) -> Any:
    try:
        # Many tools' files break a rule of the schema that nothing here depends on.
        return fmpy.read_model_description(folder, validate=False)
    except Exception as error:
        raise ControllerError(
            f"has a modelDescription.xml that cannot be read: {reason_of(error)}"
        ) from error


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


_loading = Lock()


def load_slave(path: Path, sha256: str) -> Slave:
    """Unpack an FMU, load its library and instantiate it. Raises ControllerError."""
    try:
        unpacked = unpack(path, sha256)
        try:
            return _instantiated(unpacked)
        except BaseException:
            files.remove_temporary_folder(unpacked.folder)
            raise
    except ControllerError as error:
        raise ControllerError(f"{path.name} {error}") from error


def _instantiated(unpacked: UnpackedFmu) -> Slave:
    folder, description = unpacked
    is_fmi2 = description.fmiVersion == "2.0"
    fmu = _library(fmi2.FMU2Slave if is_fmi2 else fmi3.FMU3Slave, unpacked)
    clear_log()
    try:
        if is_fmi2:
            fmu.instantiate(callbacks=FMI2_CALLBACKS)
        else:
            fmu.instantiate(logMessage=note_fmi3)
    except Exception as error:
        fmu.freeLibrary()
        raise ControllerError(with_log(f"cannot be instantiated{_tool(description)}")) from error
    return (Fmi2Slave if is_fmi2 else Fmi3Slave)(fmu, description, folder)


def _library(kind: Any, unpacked: UnpackedFmu) -> Any:
    """Load the library of an FMU. FMPy changes the working folder to do so."""
    folder, description = unpacked
    with _loading:
        working_folder = Path.cwd()
        try:
            return kind(
                guid=description.guid,
                unzipDirectory=str(folder),
                modelIdentifier=description.coSimulation.modelIdentifier,
            )
        except Exception as error:
            reason = str(error).replace(f"{folder}{os.sep}", "")
            raise ControllerError(f"cannot be loaded: {reason}") from error
        finally:
            os.chdir(working_folder)


def _tool(description: Any) -> str:
    if not description.coSimulation.needsExecutionTool:
        return ""
    return f" (it needs its tool on this machine: {description.generationTool or 'not named'})"
