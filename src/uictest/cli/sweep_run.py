"""Behind `uictest sweep` and lists of sweeps: arguments, the run while it goes on, and its result."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from importlib import import_module
from pathlib import Path
from time import perf_counter

import typer

from uictest import report, runs
from uictest.analysis import summaries
from uictest.cli.cases import malformed
from uictest.cli.options import Format, rejected
from uictest.cli.output import ExitCode, append_summary, data, message, terminal_width
from uictest.cli.progress import TerminalObserver, sweep_progress
from uictest.core import files
from uictest.plans import sweeps
from uictest.report import counted, printable
from uictest.running import chunked
from uictest.runs import history


class _WithoutPandas:
    """A finder of modules that finds no pandas."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> None:
        """Raise ModuleNotFoundError for pandas, and leave all else to the other finders."""
        if name == "pandas":
            raise ModuleNotFoundError(name)


def load_arrow() -> None:
    """Load pyarrow without pandas, which a sweep has no use for and which takes longer to load than a stop.

    With its first value pyarrow looks for pandas, once, to tell whether the value is an object of it. Where
    one is asked for later, it loads pandas all the same.
    """
    if "pandas" in sys.modules:
        return
    sys.meta_path.insert(0, _WithoutPandas)
    try:
        import_module("pyarrow").scalar(True)
    finally:
        sys.meta_path.remove(_WithoutPandas)


def selected_cases(plan: sweeps.Plan, expression: str | None) -> chunked.CaseSelection:
    """Return the cases that `-k` selects. Raises typer.BadParameter for a malformed expression."""
    with malformed("-k", expression):
        return chunked.select_cases(plan, expression)


def shard_of(text: str | None) -> chunked.Shard:
    """Return the shard that `--shard` names, else the only one. Raises typer.BadParameter."""
    with rejected("--shard"):
        return chunked.Shard() if text is None else chunked.parse_shard(text)


def cluster_address(address: str | None) -> str | None:
    """Return the address that `--dask` names. Raises typer.BadParameter."""
    with rejected("--dask"):
        if address is not None:
            chunked.check_address(address)
    return address


def frontier_search(
    plan: sweeps.Plan, key: str | None, tolerance: str | None
) -> summaries.FrontierSearch | None:
    """Return the search of `--frontier` and `--tolerance`. Raises typer.BadParameter."""
    with rejected("--frontier", summaries.FrontierError), rejected("--tolerance", runs.ToleranceError):
        return runs.frontier_search(plan, key, tolerance)


def map_pair(plan: sweeps.Plan, text: str | None) -> tuple[str, str] | None:
    """Return the parameters that `--map` names, else the first two with several listed values.

    Raises typer.BadParameter.
    """
    if text is None:
        return runs.first_pair(plan)
    first, _, second = text.partition(",")
    pair = (first.strip(), second.strip())
    unknown = [key for key in pair if key not in plan.keys]
    if unknown or pair[0] == pair[1]:
        accepted = ", ".join(plan.keys)
        raise typer.BadParameter(f"name two parameters of {accepted}, as KEY,KEY", param_hint="--map")
    return pair


def measure_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return the columns that `--measure` names, else the braking distance. Raises typer.BadParameter."""
    with rejected("--measure"):
        return runs.measure_names(names)


def show_ids(selection: chunked.CaseSelection) -> bool:
    """Write the ids of the selected cases to stdout, one per line; return whether all were accepted."""
    return all(data("\n".join(map(printable, ids))) for ids in selection.id_blocks())


def show_result(result: report.SweepResult, document: str, shown: Format, *, quiet: bool) -> None:
    """Write the result document, or maps, rates and the frontier as text, to stdout.

    If `quiet`, write only the cases that missed their expectation; annotations list these already.
    """
    if shown is Format.JSON:
        data(document.rstrip("\n"))
        return
    if quiet and shown is Format.GITHUB:
        return
    width = terminal_width(sys.stdout)
    for line in missed_lines(result) if quiet else result_lines(result, width):
        text = printable(line) if line else line
        if shown is Format.GITHUB:
            data(report.no_command(text))
        else:
            data(text if width is None else "\n".join(report.wrapped_name(text, width)))


def show_annotations(content: report.SweepContent) -> None:
    """Write the worst missed cases and the counts of the sweep as annotations to stdout."""
    for line in report.sweep_annotations(content.result, str(content.manifest.get("file", ""))):
        data(line)


def result_lines(result: report.SweepResult, width: int | None = None) -> Iterator[str]:
    """Yield maps, met cases by parameter, sensitivities and the frontier, a blank line between them.

    Maps and tables keep to `width` characters, None for any width.
    """
    for sweep_map in result.maps:
        yield from report.map_lines(sweep_map, width)
        yield ""
    yield from report.titled_lines(report.numbers_of_sweep(result), width)
    yield from missed_lines(result)
    for note in result.notes:
        yield f"note: {note}"


def missed_lines(result: report.SweepResult) -> Iterator[str]:
    """Yield the first missed cases, and the number of the others."""
    for case in result.missed:
        yield f"{case.outcome}  {case.id}  {runs.reason_missed(case.reason)}"
    if more := result.cases - result.met - len(result.missed):
        yield f"and {more} more, see {report.every_case(result.cases)}"


class SweepObserver(TerminalObserver):
    """Writes messages and progress to stderr; if `quiet`, only what went wrong or was asked for.

    `merging` says whether the chunks of shards are merged.
    """

    def __init__(self, *, quiet: bool, merging: bool) -> None:
        super().__init__(quiet=quiet)
        self._merging = merging

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
        elif missing < cases and not self.quiet:
            message(f"uictest: {cases - missing} of {counted(cases, 'case')} are already finished")

    def simulating(
        self, count: int, finished: int = 0, unit: str = "cases"
    ) -> AbstractContextManager[runs.Advance]:
        """Show the progress of the cases, or of stops that are run besides."""
        if unit != "cases":
            return super().simulating(count, finished, unit)
        return sweep_progress(count, finished, quiet=self.quiet)

    def waiting(self, address: str) -> None:
        """Report that a cluster has no workers yet."""
        message(f"uictest: waiting for workers at {address}")

    def searching(self, key: str) -> None:
        """Report that the frontier is being searched."""
        if not self.quiet:
            message(f"uictest: searching the frontier along {key}")


def execute_sweep(request: runs.SweepRequest, shown: Format, junit: Path | None, *, quiet: bool) -> ExitCode:
    """Run a sweep and show its result; return its exit code. Raises InvalidInputError, OSError."""
    try:
        return _run_and_show(request, shown, junit, quiet=quiet)
    except runs.MaxfailReached as reached:
        message(f"uictest: stopped at --maxfail: {reached}")
        message(
            f"uictest: finished chunks are kept in {request.folder}; "
            "the same command without --maxfail continues"
        )
        return ExitCode.MISSED
    except KeyboardInterrupt:
        message("uictest: interrupted")
        _report_finished_chunks(request)
        return ExitCode.INTERRUPTED
    except OSError:
        _report_finished_chunks(request)
        raise


def _run_and_show(request: runs.SweepRequest, shown: Format, junit: Path | None, *, quiet: bool) -> ExitCode:
    started = perf_counter()
    finished = runs.run_sweep(request, SweepObserver(quiet=quiet, merging=bool(request.merged)))
    if finished is None:
        message(f"uictest: {_shard_words(request)}")
        return ExitCode.MET
    if problem := history.refresh_index(request.folder.parent):
        message(f"uictest: {problem}")
    append_summary(lambda: report.append_sweep_step_summary(finished.content))
    if junit is not None:
        suite = report.sweep_suite(finished.result, request.selection.plan.file)
        files.write_to(junit, report.junit_text([suite]))
    show_result(finished.result, finished.document, shown, quiet=quiet)
    if shown is Format.GITHUB:
        show_annotations(finished.content)
    if not quiet:
        seconds = perf_counter() - started
        tally = report.sweep_tally(finished.result)
        message(f"uictest: {tally} in {seconds:.1f} s; results in {request.folder}")
    return _exit_code(finished.result)


def _report_finished_chunks(request: runs.SweepRequest) -> None:
    if chunked.ChunkStore(request.folder).has_chunks():
        message(f"uictest: finished chunks are kept in {request.folder}; the same command continues")


def _shard_words(request: runs.SweepRequest) -> str:
    shard, chunks = f"shard {request.shard.number} of {request.shard.count}", request.selection.chunks
    if request.shard.chunk_numbers(chunks):
        return f"{shard} is finished in {request.folder}"
    return f"{shard} has no cases: the sweep has only {counted(chunks, 'chunk')}"


def _exit_code(result: report.SweepResult) -> ExitCode:
    """Return the exit code of a complete sweep: an error takes precedence over a missed case."""
    if result.outcomes["error"]:
        return ExitCode.ERROR
    return ExitCode.MET if result.met == result.cases else ExitCode.MISSED
