"""The three standard streams as the process finds them."""

import os
import sys


def open_closed_streams() -> None:
    """Let streams that the caller has closed (`>&-`) lead nowhere.

    Otherwise the next file that is opened gets the free number, and whatever writes messages writes there.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if _is_closed(number):
            nowhere = os.open(os.devnull, os.O_RDWR)  # the lowest number that is free: this one
            setattr(sys, name, open(nowhere, mode, encoding="utf-8", closefd=False))  # noqa: SIM115


def _is_closed(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return True
    return False
