"""From the file of an FMU to an instance of it."""

import os
from pathlib import Path
from threading import Lock
from typing import Any

from fmpy import fmi2, fmi3

from uictest.controllers.adapters.fmu.file import UnpackedFmu, unpack
from uictest.controllers.adapters.fmu.log import FMI2_CALLBACKS, clear_log, note_fmi3, with_log
from uictest.controllers.adapters.fmu.slave import Fmi2Slave, Fmi3Slave, Slave
from uictest.controllers.adapters.instance import ControllerError
from uictest.core import files

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
