"""`uictest evaluate`: judge recorded stops like simulated ones."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs
from uictest.cli import options, recordings, run_display
from uictest.cli.earlier_runs import keep_newest, named_paths
from uictest.cli.options import option
from uictest.cli.output import ExitCode, data, message, of_run
from uictest.core import recording
from uictest.core.files import write_to
from uictest.core.recording import formats
from uictest.recorded import field_data
from uictest.running import campaign

Listing = Annotated[bool, option("--list", "List the channels of the files and the channel map that fits.")]
NewMap = Annotated[
    Path | None,
    option(
        "--write-map MAP",
        "Write a channel map for FILE to the new file MAP: what is certain, what is guessed.",
    ),
]
ScenarioFile = Annotated[
    Path | None, option("--scenario FILE", "Scenario with the test conditions and the criteria.")
]


def evaluate(
    context: typer.Context,
    files: recordings.Files,
    map_name: recordings.MapName = "uictest",
    listing: Listing = False,
    new_map: NewMap = None,
    scenario: ScenarioFile = None,
    expression: options.Expression = None,
    overrides: options.Overrides = None,
    trusted: options.Trusted = None,
    trigger: recordings.Trigger = None,
    output: options.Output = Path("reports"),
    keep: options.KeptRuns = None,
    junit: options.JUnitFile = None,
    recorded: options.RecordingChoice = options.Recorded.FAILED,
    strict: options.Strict = False,
    shown: options.RunFormat = options.Format.TEXT,
    quiet: options.Quiet = False,
    verbose: options.Verbose = False,
) -> ExitCode:
    """Judge recordings of real or simulated stops. Reports and exit codes are those of 'run'.

    FILE may also be a *.series.yaml whose stops name recordings: they are judged together, as a campaign.
    A recording does not contain the rail condition, the brake position, the state of the WSP or the criteria:
    state them with --scenario, or with --set: rail.condition, brake.position, rig.wsp and criteria.
    """
    named = named_paths(*files, scenario, junit)
    junit = options.junit_file(junit, output)
    if any(map(runs.is_series, files)):
        runs.require_nothing_stated((listing, new_map, scenario, expression, trigger), "--set")
        stops = runs.stops_of_series(files, overrides, trusted)
    else:
        mapped, inputs = recordings.channel_map(map_name, trusted, trigger)
        if new_map is not None:
            return _write_map(files, mapped, new_map)
        if listing:
            return _list(files, mapped)
        case_of = recordings.case_of_stop(scenario, expression, overrides or (), trusted)
        stops = runs.stops_in_recordings(files, mapped, inputs, case_of)
    request = campaign.RecordingRequest(recorded.value)
    batch = runs.recorded_batch(stops, context.obj, request, strict=strict)
    if not quiet:
        _write_preparation(stops.files)
    display = run_display.chosen_display(shown, quiet=quiet, verbose=verbose)
    published = run_display.publish_and_show(batch, output, ("html",), junit, display)
    if published is None:
        return ExitCode.INTERRUPTED
    code = of_run(published)
    keep_newest(code, keep, published.place, "evaluate", named)
    return code


def _write_preparation(files: Sequence[runs.RecordedFile]) -> None:
    """Write to stderr how each record was prepared, and its defects."""
    for file in files:
        if file.stop is not None:
            choices = "; ".join(f"{name}: {text}" for name, text in file.stop.choices.items())
            message(f"uictest: {file.path}: {choices}")
        for defect in file.defects:
            message(f"uictest: {file.path}: {defect}")


def _list(files: Sequence[Path], mapped: field_data.ChannelMap) -> ExitCode:
    for path, contents in zip(files, _contents(files, mapped), strict=True):
        data(report.printable(str(path)))
        for row in field_data.channel_rows(contents):
            data("  " + "\t".join(report.printable(cell) for cell in row))
        for key, text in contents.metadata.items():
            data(f"  # {report.printable(key)}: {report.printable(text)}")
        for line in _proposal(contents):
            data(line)
    return ExitCode.MET


def _contents(files: Sequence[Path], mapped: field_data.ChannelMap) -> list[recording.Contents]:
    """Return the contents of files whose dialect is found out where that of the map does not read them."""
    dialect = replace(mapped.dialect, by_itself=True)
    return runs.each_file(files, lambda path: formats.read_contents(path, dialect))


def _proposal(contents: recording.Contents) -> Iterator[str]:
    """Yield the preset that fits, or a proposed map if none fits or it fits only in part."""
    usual = contents.dialect in (None, formats.Dialect())
    preset = field_data.fitting_preset(contents) if usual else None
    partly = field_data.lacks_speeds(contents)
    for remark in field_data.remarks(contents):
        yield f"# {report.printable(remark)}"
    if preset and partly:
        yield f"# the preset {preset} fits in part: complete this map, or use the preset as it is"
    yield (
        f"the preset {preset} fits (--map {preset})"
        if preset and not partly
        else field_data.proposed_map(contents)
    )


def _write_map(files: Sequence[Path], mapped: field_data.ChannelMap, new_map: Path) -> ExitCode:
    """Write a complete map of a file. Raises InvalidInputError where `new_map` exists or is none of YAML."""
    if len(files) > 1:
        raise runs.InvalidInputError("--write-map: name one FILE, which the map is for")
    if new_map.suffix not in (".yaml", ".yml"):
        raise runs.InvalidInputError(f"--write-map {new_map}: a channel map is a .yaml file")
    if os.path.lexists(new_map):
        raise runs.InvalidInputError(f"--write-map {new_map}: exists; name a new file")
    [contents] = _contents(files, mapped)
    text = field_data.proposed_map(contents, new_map.stem)
    remarks = "".join(f"# {report.printable(remark)}\n" for remark in field_data.remarks(contents))
    heading = f"# Channel map for {report.printable(files[0].name)}: check what is marked as guessed."
    write_to(new_map, f"{heading}\n{text}\n{remarks}".encode())
    guesses = sum("# guessed" in line for line in text.splitlines())
    data(f"{report.printable(str(new_map))}: {guesses} guessed, see the file; judge with --map")
    return ExitCode.MET
