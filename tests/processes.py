"""Processes of this machine as the system lists them."""

import time
from pathlib import Path


def children_of(pid):
    """The processes that a process has started."""
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return [int(child) for task in tasks for child in task.read_text().split()]


def has_ended(pid):
    """Whether a process is gone, or waits to be collected."""
    try:
        return ") Z " in Path(f"/proc/{pid}/stat").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return True


def waited_for(condition):
    """Return what the condition gives once it is true; the machine may be slow."""
    for _ in range(12000):
        if found := condition():
            return found
        time.sleep(0.005)
    raise AssertionError("waited in vain")
