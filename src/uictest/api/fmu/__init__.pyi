from .binaries import SYSTEMS as SYSTEMS
from .compiling import (
    CannotBuildError as CannotBuildError,
    compiled as compiled,
    this_system as this_system,
)
from .controller import ControllerFmu as ControllerFmu, build_controller_fmu as build_controller_fmu
from .description import FmiVersion as FmiVersion
from .exported import NotExportableError as NotExportableError
from .rig import build_fmu as build_fmu
