"""A run as a terminal shows it while it goes on: messages, progress, results."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from uictest import report, rig, runs
from uictest.cli.compilation import compilation_shown
from uictest.cli.output import message
from uictest.cli.progress import announce_in_process, progress
from uictest.cli.running.display import Display
from uictest.judging import series
from uictest.plans import scenario
from uictest.running import campaign


class TerminalObserver(runs.Observer):
    """Shows results on stdout with a display; progress, warnings and tracebacks on stderr."""

    def __init__(
        self, display: Display, *, quiet: bool, verbose: bool, in_process: bool, colour: str = "auto"
    ) -> None:
        self._display = display
        self._quiet = quiet
        self._verbose = verbose
        self._in_process = in_process
        self._colour = colour

    @contextmanager
    def simulating(self, cases: Sequence[scenario.Case]) -> Iterator[Callable[[], None]]:
        """Announce what takes long or is dangerous, and show the progress of the stops."""
        foreign = any(case.scenario.controller.program for case in cases)
        announce_in_process(foreign=self._in_process and foreign, quiet=self._quiet)
        with compilation_shown(quiet=self._quiet, colour=self._colour):
            rig.load_stop()
        stops = sum(case.scenario.repeat for case in cases)
        unit = "stops" if stops > len(cases) else "cases"
        with progress(stops, quiet=self._quiet, unit=unit, colour=self._colour) as advance:
            yield advance

    def case(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case; with -v, the traceback of its crash, too."""
        self._display.case(run.result, differences)
        if self._verbose and run.traceback:
            message(run.traceback.rstrip())

    def case_of_series(self, run: campaign.CaseRun, differences: Sequence[report.Difference]) -> None:
        """Show a case of a series, which only -v does."""
        if self._verbose:
            self.case(run, differences)

    def series(self, result: series.SeriesResult) -> None:
        """Show a series."""
        self._display.series(result)
