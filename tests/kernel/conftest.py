"""The generator for tests, which is no part of the package."""

import ctypes
from typing import get_type_hints

import pytest

from ..conftest import fma_as_written

C_NAMES = {float: "double", int: "int64_t", bool: "bool"}
C_TYPES = {float: ctypes.c_double, int: ctypes.c_int64, bool: ctypes.c_bool}


@pytest.fixture(autouse=True, scope="session")
def _as_written():
    """The generator reads the source of a function, which must be what it runs."""
    with fma_as_written():
        yield


def exported(program, function):
    """Write a C function that calls one of numbers and returns a number, both of which its hints tell."""
    hints = get_type_hints(function)
    result, name = C_NAMES[hints.pop("return")], function.__name__
    head = ", ".join(f"{C_NAMES[kind]} {each}_given" for each, kind in hints.items())
    given = ", ".join(f"{each}_given" for each in hints)
    target = program.function(function)
    program.add(f'extern "C" EXPORT {result} {name}({head}) {{ return {target}({given}); }}\n')


def function_of(library, function):
    """Return the C function of one of numbers."""
    hints = get_type_hints(function)
    result = C_TYPES[hints.pop("return")]
    return ctypes.CFUNCTYPE(result, *(C_TYPES[kind] for kind in hints.values()))((function.__name__, library))
