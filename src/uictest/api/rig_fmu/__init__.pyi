from .building import build_fmu as build_fmu
from .linking import CannotBuildError as CannotBuildError, usable_compiler as usable_compiler
from .model_description import FmiVersion as FmiVersion
