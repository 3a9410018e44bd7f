"""What a call of foreign code can leave changed in its process, put back as it was before.

Floating-point modes change every later number, the locale what C reads as a number; the working folder, the
handlers of signals and the alarm belong to all controllers of a process. The generators of `random` and
`numpy.random` are not put back: nothing of ours draws from them.
"""

import ctypes
import locale
import os
import platform
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from struct import Struct
from threading import current_thread, main_thread
from typing import Any, Final

import numpy as np

from uictest.controllers import NOT_CALLED, ControllerError
from uictest.core.guarded_process import HAS_GUARD

_C: Final[Any] = ctypes.CDLL(None) if HAS_GUARD else None
_LAYOUT: Final = platform.machine() if sys.platform == "linux" else ""
"""Of `fenv_t`; on other systems only the rounding mode is looked at."""
_X86: Final = Struct("<H26xI")
_MODES: Final = (0x400, 0x800, 0xC00, 0x800000, 0x400000, 0xC00000)  # of x86, of Arm
_ROUNDING: Final = dict(zip(_MODES, 2 * ("downward", "upward", "toward zero"), strict=True))
_NAMES: Final = ("HUP", "INT", "QUIT", "ILL", "ABRT", "BUS", "FPE", "SEGV", "PIPE", "ALRM", "TERM", "CHLD")
_SIGNALS: Final = [(getattr(signal, f"SIG{name}", 0), f"handler of SIG{name}") for name in _NAMES]
_SLOT: Final = 256
"""Bytes for a `fenv_t` or a `sigaction`; chosen, at least those of any system."""
_Slots = ctypes.c_char * (_SLOT * (1 + len(_SIGNALS)))


def require_guard() -> None:
    """Raise ControllerError where a controller from outside could not be kept from harming the program."""
    if not HAS_GUARD:
        raise ControllerError(
            "a controller from outside (C library, Python class, FMU, program at a socket) needs Linux: on "
            "Windows install and run uictest in the Windows Subsystem for Linux, or use a built-in controller"
        )


class ProcessState:
    """The state of this process and thread at one time."""

    def __init__(self) -> None:
        self._slots = _Slots()
        self._values = _values(self._slots)

    def restore(self) -> dict[str, str]:
        """Put back what has changed since; return its names in words, each with what it had become."""
        now = _values(_Slots())
        changed = {name: now[name] for name, value in self._values.items() if now[name] != value}
        if not changed:
            return {}
        address = ctypes.addressof(self._slots)
        _C.fesetenv(ctypes.c_void_p(address))
        locale.setlocale(locale.LC_ALL, self._values["locale"])
        np.seterr(**self._values["numpy.seterr"])
        with suppress(OSError):  # a folder that is gone
            os.chdir(self._values["working folder"])
        if "alarm" in changed:  # without its handler it would end the process
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, name in _SIGNALS:
            address += _SLOT
            if name in changed:
                handler, _ = self._values[name]
                if handler is not None and current_thread() is main_thread():  # elsewhere Python can set none
                    signal.signal(number, handler)
                _C.sigaction(number, ctypes.c_void_p(address), None)
        return {name: value if isinstance(value, str) else "" for name, value in changed.items()}


class ControllerCalls:
    """Calls of controllers: told in the exchange; what they change of the process is put back and noted."""

    def __init__(self, exchange: Any) -> None:
        require_guard()
        self.exchange = exchange
        self.traces: dict[tuple[str, str], str] = {}
        """What was changed and the call -> in words."""
        self._state = ProcessState()

    @contextmanager
    def of(self, call: str, calling: int) -> Iterator[None]:
        """Say in the exchange what a controller is called for meanwhile."""
        self.exchange["calling"] = calling
        try:
            yield
        finally:
            self.exchange["calling"] = NOT_CALLED  # whoever watches a block asks which call does not return
            self.restore_state(call)

    def restore_state(self, call: str) -> None:
        """Put back what a call has changed."""
        for name, value in self._state.restore().items():
            self.traces.setdefault((name, call), f"{name} {value}".strip() + f" after {call}")


def _values(slots: Any) -> dict[str, Any]:
    """Return the state by name, and write what C puts back of it."""
    address = ctypes.addressof(slots)
    _C.fegetenv(ctypes.c_void_p(address))
    try:
        folder = os.getcwd()  # noqa: PTH109 - Path.cwd takes ten times as long
    except FileNotFoundError:
        folder = "removed"
    values = {
        **_floating_point(slots),
        "locale": locale.setlocale(locale.LC_ALL),
        "working folder": folder,
        "numpy.seterr": np.geterr(),
        "alarm": "set" if any(signal.getitimer(signal.ITIMER_REAL)) else "not set",
    }
    for number, name in _SIGNALS:
        address += _SLOT
        _C.sigaction(number, None, ctypes.c_void_p(address))  # begins with the address of the handler
        values[name] = signal.getsignal(number), ctypes.c_void_p.from_address(address).value
    return values


def _floating_point(fenv: Any) -> dict[str, object]:
    """Return the modes in a floating-point environment, without the flags that every operation sets."""
    rounding, flushing, others = _C.fegetround(), 0, 0
    if _LAYOUT == "x86_64":  # control word of the x87 unit, and MXCSR
        x87, sse = _X86.unpack_from(fenv)
        rounding, flushing = sse >> 3 & 0xC00, sse & 0x8040
        others = x87 & 0x33F | (x87 ^ sse >> 3) & 0xC00 | (sse & 0x1F80) << 16
    if _LAYOUT == "aarch64":
        control = int.from_bytes(fenv[:4], "little")
        rounding, flushing, others = control & 0xC00000, control & 0x1000000, control & 0x9F00
    return {
        "rounding mode": _ROUNDING.get(rounding, "to nearest"),
        "subnormal numbers": "flushed to zero" if flushing else "kept",
        "traps and precision of floating point": others,
    }
