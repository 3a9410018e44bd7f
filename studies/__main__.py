"""`./reproduce`: run the studies and show the paper's values next to ours."""

from __future__ import annotations

import argparse
import json
import os
import sys
import traceback
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Final, NoReturn

from studies.comparison import claims, document, lines, misses, study_table, tally
from studies.stop_runner import StopRunner
from studies.study import STUDIES, Study, StudyResult, run_study
from studies.writing import write_comparison, write_figures, write_pages, write_tables
from uictest import report

HOLDS, MISSES, INTERRUPTED, ERROR, USAGE = range(5)
"""Exit codes, those of `uictest`: a crash never exits with 1."""
_DESCRIPTION: Final = """
Run the studies of the paper and print its values next to ours. Writes a page for each.

Each value has a status (calibrated, selected, by construction, predicted) and a result (holds, misses,
shown).
"""
_EPILOG: Final = """
Exit codes: 0 every value is as claimed; 1 a value misses its band, unless that is the paper's and declared
missed, or a declared miss holds; 2 interrupted; 3 error; 4 usage.
"""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(USAGE, f"uictest: {message}\nTry './reproduce --help'.\n")


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = _Parser("./reproduce", description=_DESCRIPTION, epilog=_EPILOG)
    parser.add_argument("names", metavar="STUDY", nargs="*", help="names of studies [default: all]")
    parser.add_argument("--list", action="store_true", help="list the studies and run none")
    parser.add_argument(
        *("-o", "--output"),
        metavar="DIR",
        type=Path,
        default=Path("reports", "studies"),
        help="folder for pages, data and figures [default: reports/studies]",
    )
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output on stdout")
    parser.add_argument(
        *("-n", "--jobs"), metavar="N|auto", type=_jobs, default="auto", help="number of threads"
    )
    parser.add_argument(
        *("-q", "--quiet"), action="store_true", help="show only the values that miss their band"
    )
    options = parser.parse_args(arguments)
    for name in options.names:
        if name not in STUDIES:
            near = get_close_matches(name, STUDIES, 1)
            hint = f"did you mean {near[0]!r}?" if near else f"accepted: {', '.join(sorted(STUDIES))}"
            parser.error(f"no study {name!r}; {hint}")
    return options


def _jobs(text: str) -> int:
    if text == "auto":
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if text.isascii() and text.isdigit() and int(text) > 0:
        return int(text)
    raise argparse.ArgumentTypeError(f"{text!r} is neither a number of threads from 1 nor 'auto'")


def main(arguments: Sequence[str]) -> int:
    """Run the studies that are named, and return the exit code. Exits where an argument is wrong."""
    options = _options(arguments)
    selected = [study for name, study in STUDIES.items() if not options.names or name in options.names]
    try:
        return _list(selected, options.format) if options.list else _reproduce(selected, options, arguments)
    except KeyboardInterrupt:
        _message("interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        # The reader has gone (`| head`), and what is still in the buffer must not raise again at the exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return HOLDS
    except Exception as error:
        if isinstance(error, OSError):
            _message(str(error))
        else:
            traceback.print_exc()
            _message(f"internal error: {type(error).__name__}: {error}")
        return ERROR


def _list(selected: Sequence[Study], form: str) -> int:
    if form == "json":
        _print(json.dumps([{"name": study.name, "title": study.title} for study in selected], indent=2))
    else:
        width = max(len(study.name) for study in selected)
        _print("\n".join(f"{study.name.ljust(width)}  {study.title}" for study in selected))
    return HOLDS


def _reproduce(selected: Sequence[Study], options: argparse.Namespace, arguments: Sequence[str]) -> int:
    results = _run(selected, options)
    drawn = _draw(results, options.output)
    for problem in write_pages(options.output, results, list(STUDIES.values()), arguments, drawn):
        _message(problem)
    if options.format == "json":
        _print(document(results))
    elif options.quiet:
        _print("\n".join([*misses(results), *claims(results)]))
    else:
        _show(results)
    failed = [each.study.name for each in results if each.fails]
    if not options.quiet:
        amiss = f"; not as claimed: {', '.join(failed)}" if failed else ""
        counted = report.counted(len(results), "study", "studies")
        _message(f"{counted}, {tally(results)}{amiss}; in {options.output}")
    return MISSES if failed else HOLDS


def _run(selected: Sequence[Study], options: argparse.Namespace) -> list[StudyResult]:
    """Run the studies one after the other, and write the tables of each as soon as it has ended."""
    stop_runner = StopRunner(options.jobs)
    results: list[StudyResult] = []
    for study in selected:
        if not options.quiet:
            _message(f"{study.name}...")
        results.append(run_study(study, stop_runner))
        write_tables(options.output, results[-1])
    write_comparison(options.output, results)
    return results


def _draw(results: Sequence[StudyResult], output: Path) -> list[Path]:
    """Draw the figures, and return their files; without matplotlib there are none."""
    try:
        return [path for result in results for path in write_figures(output, result)]
    except ImportError as error:
        missing = error.name or "matplotlib"
        _message(f"no figures: {missing} is not installed (pip install 'uictest[figures]')")
        return []


def _show(results: Sequence[StudyResult]) -> None:
    """Print the values of every study, as tables where a person watches."""
    if sys.stdout.isatty() and os.environ.get("CI", "").lower() in ("", "0", "false"):
        from rich.console import Console

        console = Console(highlight=False)
        for each in results:
            console.print(study_table(each))
    else:
        for each in results:
            _print("\n".join(lines(each)))
    if len(results) > 1:
        _print("\n".join(claims(results)))


def _print(text: str) -> None:
    print(text, flush=True)


def _message(text: str) -> None:
    print(f"uictest: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
