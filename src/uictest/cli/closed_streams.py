"""Standard streams that the caller has closed."""

import os
import sys


def open_closed_streams() -> None:
    """Open streams that the caller has closed (`>&-`) on the null device.

    Otherwise the next file that is opened gets the free number, and messages are written into it.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if _is_closed(number):
            null_device = os.open(os.devnull, os.O_RDWR)  # the lowest number that is free: this one
            setattr(sys, name, open(null_device, mode, encoding="utf-8", closefd=False))  # noqa: SIM115


def _is_closed(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return True
    return False
