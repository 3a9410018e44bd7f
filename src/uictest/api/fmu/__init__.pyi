from .building import CannotBuildError as CannotBuildError, usable_compiler as usable_compiler
from .controller import ControllerFmu as ControllerFmu, build_controller_fmu as build_controller_fmu
from .description import FmiVersion as FmiVersion
from .exported import NotExportableError as NotExportableError, library_of_sources as library_of_sources
from .rig import build_fmu as build_fmu
