"""A child process that ends with this one, however that ends, and then leaves no temporary file.

    python -m uictest.core.guarded_process LIFELINE FOLDER MODULE ARGUMENT...

LIFELINE is a pipe that the parent holds open. When its end is gone, the guard of the child ends it and every
process that it has started, and removes FOLDER, which has temporary files. The guard is a process of its own:
a thread of the child would wait for an interpreter that foreign code may never release. Windows has no guard:
there its parent alone ends a child.
"""

import os
import runpy
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

HAS_GUARD: Final = hasattr(os, "fork")
_ENDED: Final = b"."
"""What a parent writes that ends its child itself, and goes on using the folder."""


class GuardedProcess(subprocess.Popen[bytes]):
    """A module run by an interpreter of its own, whose temporary files lie in a folder of the caller's.

    Args:
        module: what is run as `__main__`.
        arguments: its `sys.argv[1:]`.
        folder: for temporary files.
        flags: of the interpreter.
        options: of :class:`subprocess.Popen`.
    """

    def __init__(
        self,
        module: str,
        arguments: Sequence[str],
        folder: Path,
        flags: Sequence[str],
        pass_fds: Sequence[int] = (),
        **options: Any,
    ) -> None:
        command, end, self._lifeline = ["-m", module, *arguments], -1, -1
        if HAS_GUARD:
            end, self._lifeline = os.pipe()
            command = ["-m", __name__, str(end), str(folder), module, *arguments]
            # Signals of the terminal are for this process, which ends the child and what it has started.
            options |= {"pass_fds": (*pass_fds, end), "start_new_session": True}
        environment = {**os.environ, **dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder))}
        try:
            super().__init__([sys.executable, *flags, *command], env=environment, **options)
        except BaseException:
            self._close_lifeline()
            raise
        finally:
            if HAS_GUARD:
                os.close(end)

    def end(self) -> None:
        """End it and whatever it has started."""
        if self.returncode is None:  # its number is no other's before it is collected
            with suppress(ProcessLookupError):
                os.killpg(self.pid, signal.SIGKILL) if HAS_GUARD else self.kill()
        self.wait()
        self._close_lifeline()

    def __exit__(self, *error: object) -> None:
        self.end()
        super().__exit__(None, None, None)

    def _close_lifeline(self) -> None:
        # Only once: the number of a closed pipe may be that of another soon.
        lifeline, self._lifeline = self._lifeline, -1
        if lifeline >= 0:
            with suppress(BrokenPipeError):
                os.write(lifeline, _ENDED)
            os.close(lifeline)


def reading_process(module: str, arguments: Sequence[str], folder: Path) -> GuardedProcess:
    """Start a module that reads a foreign file and works in a folder, with pipes for input and output."""
    # -I: neither the environment nor the working folder, where the file may lie, decides what is imported.
    # -B: on a full disk Python could leave half a compiled module, which every later reader would fail on.
    pipe, silent = subprocess.PIPE, subprocess.DEVNULL
    return GuardedProcess(
        module, arguments, folder, ["-I", "-B"], cwd=folder, stdin=pipe, stdout=pipe, stderr=silent
    )


def bound_resources(memory: int, seconds: float | None) -> None:
    """Limit the address space of this process, bytes, and its processor time where the system can."""
    if resource is None:
        return
    with suppress(ValueError, OSError):  # elsewhere the time limit of who waits for it must do
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if seconds is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 1))


def _leave_guard(lifeline: int, folder: str) -> None:
    """Fork the guard of this process, which must have no thread yet and be a process group of its own."""
    group = os.getpid()
    if os.fork() != 0:
        os.close(lifeline)
        return
    try:
        # Whoever waits for the child to close its streams must not wait for the guard.
        os.closerange(0, 3)
        ended_by_parent = os.read(lifeline, 1) == _ENDED
        # The number of the group is not given to others while the guard is in its session.
        os.setpgid(0, 0)
        with suppress(ProcessLookupError):
            os.killpg(group, signal.SIGKILL)
        if not ended_by_parent:
            shutil.rmtree(folder, ignore_errors=True)
    finally:
        os._exit(0)


if __name__ == "__main__":
    _leave_guard(int(sys.argv[1]), sys.argv[2])
    del sys.argv[:3]
    runpy.run_module(sys.argv[0], run_name="__main__")
