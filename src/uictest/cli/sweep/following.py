"""A sweep as a terminal shows it while it goes on: messages and progress."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

from uictest import runs
from uictest.cli.compilation import compilation_shown
from uictest.cli.output import message
from uictest.cli.progress import announce_in_process
from uictest.cli.sweep.progress import sweep_progress
from uictest.report import counted


class TerminalSweepObserver(runs.SweepObserver):
    """Writes messages and progress to stderr; if `quiet`, only what went wrong or was asked for.

    `merging` says whether the chunks of shards are merged.
    """

    def __init__(self, *, quiet: bool, merging: bool) -> None:
        self._quiet = quiet
        self._merging = merging

    def foreign_in_process(self) -> None:
        """Announce that controllers from outside can crash this process."""
        announce_in_process(foreign=True, quiet=self._quiet)

    def compiling(self) -> AbstractContextManager[None]:
        """Show the compilation of the rig."""
        return compilation_shown(quiet=self._quiet)

    def damaged(self, chunk: Path) -> None:
        """Report a damaged chunk."""
        message(f"uictest: {chunk} is damaged: recomputing this chunk")

    def damaged_in_shard(self, chunk: Path) -> None:
        """Report a damaged chunk of a shard."""
        message(f"uictest: {chunk} is damaged: skipped")

    def merged(self, chunks: int, shard: Path) -> None:
        """Report what a shard brought."""
        message(f"uictest: {counted(chunks, 'chunk')} from {shard}")

    def found(self, cases: int, missing: int) -> None:
        """Report how many cases are already finished, or how many no shard provided."""
        if self._merging and missing:
            verb = "is" if missing == 1 else "are"
            pronoun = "it" if missing == 1 else "them"
            message(
                f"uictest: {missing} of {counted(cases, 'case')} {verb} missing from the shards: "
                f"simulating {pronoun} here"
            )
        elif missing < cases and not self._quiet:
            message(f"uictest: {cases - missing} of {counted(cases, 'case')} are already finished")

    def simulating(self, cases: int, finished: int) -> AbstractContextManager[Callable[[int], None]]:
        """Show the progress of the cases."""
        return sweep_progress(cases, finished, quiet=self._quiet)

    def waiting(self, address: str) -> None:
        """Report that a cluster has no workers yet."""
        message(f"uictest: waiting for workers at {address}")

    def searching(self, key: str) -> None:
        """Report that the frontier is being searched."""
        if not self._quiet:
            message(f"uictest: searching the frontier along {key}")
