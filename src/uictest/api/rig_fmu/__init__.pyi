from .building import (
    CannotBuildError as CannotBuildError,
    build_fmu as build_fmu,
    usable_compiler as usable_compiler,
)
from .description import FmiVersion as FmiVersion
