"""Controllers in C: a shared library with the functions of ``uictest_controller.h``."""

import ctypes
import platform
from functools import cache
from pathlib import Path
from typing import Any, Final

from uictest.controllers.adapters.instance import (
    ControllerError,
    ControllerInstance,
    checked_contract,
    reject_undeclared,
    unchanged_content,
)
from uictest.controllers.declared import ControllerProgram
from uictest.controllers.interface import WHEELSETS, Config

_Radii = ctypes.c_double * WHEELSETS


class _Config(ctypes.Structure):
    """`uictest_config`."""

    _fields_ = (
        ("wheelsets", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
        ("cycle_time", ctypes.c_double),
        ("initial_speed", ctypes.c_double),
        ("wheel_radius", _Radii),
        ("parameters", ctypes.c_char_p),
    )


_FUNCTIONS: Final[dict[str, tuple[Any, tuple[Any, ...]]]] = {
    "abi_version": (ctypes.c_uint32, ()),
    "create": (ctypes.c_void_p, (ctypes.c_void_p,)),
    "reset": (ctypes.c_int32, (ctypes.c_void_p,)),
    "step": (ctypes.c_int32, (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)),
    "destroy": (None, (ctypes.c_void_p,)),
    "last_error": (ctypes.c_char_p, (ctypes.c_void_p,)),
}
"""Name after the prefix `uictest_` -> type of the result, types of the arguments."""
_LOADED: Final[dict[str, str]] = {}
"""Libraries that this process has loaded: path -> SHA-256."""
_IN_USE: Final[set[int]] = set()
"""Handles of the controllers that are open in this process."""


class LibraryInstance(ControllerInstance):
    """A controller that a library has created."""

    runs_beside_others = True

    def __init__(self, library: Any, config: Config, parameters: str) -> None:
        self._library = library
        self.contract = library.contract
        self.version, self.declares = (
            _stated_text(library, name) or "" for name in ("version", "parameters")
        )
        speeds = config.cycle_time, config.initial_speed, _Radii(*config.wheel_radius)
        given = _Config(config.wheelsets, 0, *speeds, parameters.encode())
        handle = library.uictest_create(ctypes.byref(given))
        if not handle:
            raise ControllerError(f"uictest_create failed: {_last_error(library, None) or 'no reason given'}")
        if handle in _IN_USE:  # both would step one state, and mix their stops
            raise ControllerError(
                "uictest_create returned a controller that is in use: each needs memory of its own"
            )
        _IN_USE.add(handle)
        self.handle = int(handle)
        self.step_address = ctypes.cast(library.uictest_step, ctypes.c_void_p).value or 0

    def reset(self) -> None:
        """Call `uictest_reset`."""
        status = self._library.uictest_reset(self.handle)
        if status != 0:
            reason = self.last_error() or "no reason given"
            raise ControllerError(f"uictest_reset returned {status}: {reason}")

    def last_error(self) -> str:
        """Call `uictest_last_error`."""
        return _last_error(self._library, self.handle)

    def close(self) -> None:
        """Call `uictest_destroy`."""
        _IN_USE.discard(self.handle)
        self._library.uictest_destroy(self.handle)


def open_controller(program: ControllerProgram, config: Config) -> ControllerInstance:
    """Load the library, once per process, and create a controller. Raises ControllerError."""
    library = _loaded_library(program.location, program.sha256)
    reject_undeclared(program, _stated_text(library, "parameters"))
    return LibraryInstance(library, config, program.parameters)


@cache
def _loaded_library(location: str, sha256: str) -> Any:
    path = Path(location)
    if _LOADED.get(location, sha256) != sha256:  # the system's loader would return the one that it has
        raise ControllerError(f"{path.name} was built anew: this process has loaded it before; start another")
    content = unchanged_content(path, sha256)
    try:
        library: Any = ctypes.CDLL(location)
    except OSError as error:
        reason = str(error).replace(location, path.name)  # without the folders of this machine
        if content.startswith(b"MZ"):
            reason = (
                f"it is built for Windows, expected a library for {platform.system()} {platform.machine()}"
            )
        raise ControllerError(f"{path.name} cannot be loaded: {reason}") from error
    _LOADED[location] = sha256
    unchanged_content(path, sha256)  # nothing else was loaded meanwhile
    missing = [f"uictest_{name}" for name in _FUNCTIONS if not hasattr(library, f"uictest_{name}")]
    if missing:
        raise ControllerError(f"{path.name} does not export {', '.join(missing)}")
    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(library, f"uictest_{name}")
        function.restype, function.argtypes = result, arguments
    # Asked once: what it is given, and what is recorded, is of the version that was checked.
    library.contract = checked_contract(library.uictest_abi_version(), f"{path.name} has ABI version")
    return library


def _stated_text(library: Any, name: str) -> str | None:
    """Return the result of an optional function of the library; None where the function is missing."""
    function = getattr(library, f"uictest_{name}", None)
    if function is None:
        return None
    function.restype = ctypes.c_char_p
    return _decoded_text(function())


def _last_error(library: Any, handle: int | None) -> str:
    return _decoded_text(library.uictest_last_error(handle))


def _decoded_text(content: bytes | None) -> str:
    return (content or b"").decode("utf-8", "replace")
