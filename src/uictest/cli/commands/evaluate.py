"""`uictest evaluate`: judge recordings by the code that judges simulated stops."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from uictest import campaign, field_data, recording, report
from uictest.cli.exit_codes import ExitCode, of_campaign
from uictest.cli.options import (
    Colour,
    Colouring,
    Expression,
    Format,
    Output,
    Overrides,
    Quiet,
    Recorded,
    Recording,
    RunFormat,
    Trusted,
    Verbosity,
)
from uictest.cli.problems import InvalidInputError
from uictest.cli.recordings import (
    Files,
    LowPass,
    MapName,
    Raster,
    Trigger,
    TriggerLead,
    channel_map,
    each_file,
    one_case,
)
from uictest.cli.streams import data, message
from uictest.recording import formats
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.scenario import Case

_OPTIONS = {
    "rail.condition": "--rail",
    "brake.position": "--position",
    "rig.wsp": "--wsp",
    "criteria": "--criteria",
}
"""What must be stated of a recording -> the option that states it."""


def evaluate(
    context: typer.Context,
    files: Files,
    map_name: MapName = "uictest",
    listing: Annotated[
        bool, typer.Option("--list", help="Show what the files hold, and which channel map fits.")
    ] = False,
    scenario: Annotated[
        Path | None,
        typer.Option("--scenario", metavar="FILE", help="States circumstances and criteria of the stop."),
    ] = None,
    expression: Expression = None,
    criteria: Annotated[
        list[str] | None,
        typer.Option("--criteria", metavar="NAME", help="Criteria to judge by; may be repeated."),
    ] = None,
    rail: Annotated[str | None, typer.Option("--rail", metavar="NAME", help="Rail condition.")] = None,
    position: Annotated[
        str | None, typer.Option("--position", metavar="NAME", help="Brake position.")
    ] = None,
    wsp: Annotated[str | None, typer.Option("--wsp", metavar="STATE", help="active or bypassed.")] = None,
    overrides: Overrides = None,
    trusted: Trusted = None,
    trigger: Trigger = None,
    trigger_lead: TriggerLead = None,
    raster: Raster = None,
    low_pass: LowPass = None,
    output: Output = Path("reports"),
    junit: Annotated[
        Path | None, typer.Option("--junitxml", metavar="FILE", help="Write the JUnit XML to this file, too.")
    ] = None,
    recorded: Recording = Recorded.FAILED,
    shown: RunFormat = Format.TEXT,
    quiet: Quiet = False,
    verbosity: Verbosity = 0,
    colour: Colouring = Colour.AUTO,
) -> ExitCode:
    """Judge measured or simulated recordings. Reports and exit codes are those of 'run'.

    A recording does not hold the rail condition, the brake position, the state of the WSP or the criteria:
    state them by a scenario, or by options.
    """
    mapped, inputs = channel_map(
        map_name, trusted, trigger=trigger, trigger_lead=trigger_lead, raster=raster, low_pass=low_pass
    )
    if listing:
        return _list(files, mapped)
    chosen = f"[{', '.join(criteria)}]" if criteria else None
    given = {"rail.condition": rail, "brake.position": position, "rig.wsp": wsp, "criteria": chosen}
    statements = [*(f"{key}={text}" for key, text in given.items() if text is not None), *(overrides or ())]
    stated = _stated(scenario, expression, statements, trusted)

    from uictest.cli.display import chosen_display
    from uictest.cli.recorded_batch import judge_all, publish, read_all, subjects_of, tell, traces_of

    recordings = read_all(files, mapped)
    cases = [_checked(lambda m=measured: m.case(stated, inputs)) for measured in recordings]  # type: ignore[misc]
    read = {name: digest for case in cases for name, digest in case.inputs.items()}
    parts = campaign.parts_of_recorded(cases)
    examined = [campaign.with_parts(each, parts) for each in judge_all(recordings, cases)]
    done, place = publish(
        examined,
        campaign.RecordingRequest(recorded.value),
        report.run_manifest(context.obj.arguments, None, read, len(cases), parts.values()),
        output,
        junit,
        chosen_display(shown, colour, quiet=quiet, verbose=verbosity > 0),
        subjects_of(recordings, cases),
        traces_of(examined),
    )
    if not quiet:
        tell(recordings)
        message(f"uictest: {report.tally(done.results)}; reports in {place}")
    return of_campaign(done)


def _stated(
    scenario: Path | None,
    expression: str | None,
    statements: Sequence[str],
    trusted: Sequence[Path] | None,
) -> Callable[[str, float], Case]:
    """Return what makes a case of a recording. Raises InvalidInputError where too little is stated."""
    if scenario is not None:
        base = one_case(scenario, expression, statements, trusted)
        return lambda name, speed: base

    keys = {statement.partition("=")[0].strip() for statement in statements}
    missing = [_OPTIONS[key] for key in field_data.REQUIRED_STATEMENTS if key not in keys]
    if missing:
        raise InvalidInputError(
            "uictest: a recording does not say what was tested: state it with --scenario FILE, or with"
            f" {', '.join(missing)}"
        )
    return lambda name, speed: field_data.stated_case(name, speed, statements, trusted or ())


def _checked(make: Callable[[], Case]) -> Case:
    try:
        return make()
    except yaml.ScenarioErrors as errors:
        raise InvalidInputError(str(errors)) from errors


def _list(files: Sequence[Path], mapped: field_data.ChannelMap) -> ExitCode:
    for path, contents in zip(
        files, each_file(files, lambda p: formats.read_contents(p, mapped.dialect)), strict=True
    ):
        data(report.printable(str(path)))
        for row in field_data.channel_rows(contents):
            data("  " + "\t".join(report.printable(cell) for cell in row))
        for key, text in contents.metadata.items():
            data(f"  # {report.printable(key)}: {report.printable(text)}")
        for line in _proposal(contents, mapped.dialect):
            data(line)
    return ExitCode.MET


def _proposal(contents: recording.Contents, dialect: formats.Dialect) -> Iterator[str]:
    """Yield the preset that fits and what it leaves open, or a map to begin with where it does so in part."""
    preset = field_data.fitting_preset(contents) if dialect == formats.Dialect() else None
    partly = field_data.lacks_speeds(contents)
    for remark in field_data.remarks(contents):
        yield f"# {report.printable(remark)}"
    if preset and partly:
        yield f"# the preset {preset} fits in part: complete this map, or use the preset as it is"
    yield (
        f"the preset {preset} fits (--map {preset})"
        if preset and not partly
        else field_data.proposed_map(contents, dialect)
    )
