from .building import (
    SYSTEMS as SYSTEMS,
    CannotBuildError as CannotBuildError,
    compiled as compiled,
    this_system as this_system,
)
from .controller import (
    ControllerFmu as ControllerFmu,
    NotExportableError as NotExportableError,
    build_controller_fmu as build_controller_fmu,
)
from .description import FmiVersion as FmiVersion
from .rig import build_fmu as build_fmu
