"""What a child process prints, as far as it is kept: one pipe for standard output and standard error."""

import os
from contextlib import suppress
from typing import Final

LARGEST_OUTPUT: Final = 2**20
"""Bytes that are kept of what a controller prints in a stop; chosen: some ten thousand lines."""
_PIPE: Final = 2**16
"""Bytes that a pipe holds at most."""


class PrintedOutput:
    """The pipe of a child, which is given `its_end`; None where it prints to our standard error."""

    def __init__(self, *, kept: bool) -> None:
        self.its_end: int | None = None
        self.open_ends: list[int] = []
        """Our end, until the child has closed its own."""
        if kept:
            end, self.its_end = os.pipe()
            os.set_blocking(end, False)
            self.open_ends.append(end)
        self._kept, self._size = bytearray(), 0

    def read(self) -> None:
        """Take what is there: more than a pipe holds has no place to wait."""
        for end in self.open_ends:
            with suppress(BlockingIOError):
                part = os.read(end, _PIPE)
                self._size += len(part)
                self._kept += part[: LARGEST_OUTPUT - len(self._kept)]
                if not part:
                    self.close()

    def taken(self) -> str:
        """Return what was printed since the last time, and how much of that was not kept."""
        self.read()
        text, lost = self._kept.decode("utf-8", "replace"), self._size - len(self._kept)
        self._kept, self._size = bytearray(), 0
        return f"{text}\n... {lost} bytes more, {LARGEST_OUTPUT} are kept\n" if lost else text

    def close(self) -> None:
        """Close our end."""
        while self.open_ends:
            os.close(self.open_ends.pop())
