"""`uictest log`: find and judge the stops in long recordings."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs
from uictest.analysis import logged_stops
from uictest.cli import options, recordings, run_display
from uictest.cli.cases import malformed
from uictest.cli.options import option, rejected
from uictest.cli.output import ExitCode, message, of_run
from uictest.core import files as file_system
from uictest.core.recording import formats
from uictest.plans import scenario as scenarios
from uictest.plans.scenario import yaml
from uictest.recorded import field_data, service_log
from uictest.running import campaign

FromSpeed = Annotated[str, option("--from SPEED", "Least speed at which the brake is applied.")]
ToSpeed = Annotated[str, option("--to SPEED", "Speed down to which a stop comes; 0: standstill.")]
StopsFolder = Annotated[Path, option("--recordings DIR", "Where every stop is written.")]
ScenarioFile = Annotated[
    Path | None, option("--scenario FILE", "Scenario with the test conditions and the criteria.")
]
DryStops = Annotated[
    str | None,
    option("--dry EXPR", "Stops on a dry rail, by name or file, as -k selects; the others are as stated."),
]
_ON_DRY_RAIL = ("rail.condition=dry", "rail.friction=null", "rail.cleaning=null")
"""What is stated of these."""


def log(
    context: typer.Context,
    files: recordings.Files,
    map_name: recordings.MapName = "uictest",
    from_speed: FromSpeed = "20 km/h",
    to_speed: ToSpeed = "0 km/h",
    folder: StopsFolder = Path("stops"),
    scenario: ScenarioFile = None,
    dry: DryStops = None,
    expression: options.Expression = None,
    overrides: options.Overrides = None,
    trusted: options.Trusted = None,
    output: options.Output = Path("reports"),
    junit: options.JUnitFile = None,
    strict: options.Strict = False,
    shown: options.RunFormat = options.Format.TEXT,
    quiet: options.Quiet = False,
    verbose: options.Verbose = False,
) -> ExitCode:
    """Find the stops in long recordings and judge each. Several files are one log.

    Conditions are stated as for 'evaluate'. Applications of the brake that are no stops are listed with the
    reason. Reports and exit codes are those of 'run'; 5 where there is no stop, with reports that say so.
    """
    junit = options.junit_file(junit, output)
    mapped, inputs = recordings.channel_map(map_name, trusted, None)
    _require_many_triggers(map_name, mapped.preparation)
    settings = _finder_settings(from_speed, to_speed, float(mapped.preparation.standstill_speed))
    # What is stated wrongly is told before the log is read.
    stated = recordings.case_of_stop(scenario, expression, overrides or (), trusted)
    vehicle_known = stated("log", settings.from_speed).vehicle_stated
    is_dry = _selected_by(dry)
    in_log, written = _found_stops(files, mapped, settings, folder)
    if not quiet:
        _write_events(in_log)
    named = {f"stop-{number:04d}": event for number, event in enumerate(in_log.stops, start=1)}
    on_dry_rail = frozenset(name for name, event in named.items() if is_dry(name, event.file))
    if dry is not None and named and not on_dry_rail:
        raise typer.BadParameter(f"{dry}: selects no stop", param_hint="--dry")
    of_dry = stated
    if on_dry_rail:
        on_dry = (*(overrides or ()), *_ON_DRY_RAIL)
        of_dry = recordings.case_of_stop(scenario, expression, on_dry, trusted)

    def case_of(name: str, speed: float) -> scenarios.Case:
        return of_dry(name, speed) if name in on_dry_rail else stated(name, speed)

    stops = runs.stops_in_recordings(list(written), _canonical_map(mapped), inputs, case_of, found=True)
    if any(file.digest != written[file.path] for file in stops.files):
        raise runs.InvalidInputError(
            f"{folder}: another log was written there: name a folder with --recordings"
        )
    together = logged_stops.StopsTogether(named, in_log.passed_over, vehicle_known=vehicle_known)
    request = campaign.RecordingRequest("all")
    batch = runs.recorded_batch(stops, context.obj, request, strict=strict, observe=together.add)
    batch = batch._replace(
        passed_over=[_passed_over_sentence(event) for event in in_log.passed_over],
        together=lambda results, _: together.campaign(results),
    )
    display = run_display.chosen_display(shown, quiet=quiet, verbose=verbose)
    published = run_display.publish_and_show(batch, output, ("html",), junit, display)
    if published is None:
        return ExitCode.INTERRUPTED
    if not named:
        message(f"uictest: {together.without_stop}")
        return ExitCode.NOTHING_SELECTED
    return of_run(published)


def _require_many_triggers(map_name: str, preparation: field_data.Preparation) -> None:
    """Raise InvalidInputError for a channel map whose trigger is one brake command."""
    if preparation.trigger_time is not None or preparation.trigger not in service_log.SHOWN_BY:
        raise runs.InvalidInputError(
            f"{map_name}: preparation: a log has many brake commands: leave out trigger_time, and set trigger"
            f" to one of {', '.join(service_log.SHOWN_BY)}"
        )


def _selected_by(expression: str | None) -> Callable[[str, Path], bool]:
    """Return whether `--dry` selects a stop, by its name, its file or, with a slash, a part of its path."""
    if expression is None:
        return lambda name, path: False
    with malformed("--dry", expression):
        selects = campaign.parse(expression)

    def selected(name: str, path: Path) -> bool:
        by_name, by_path = map(campaign.mentioned_in, ((name, path.name), (path.as_posix(),)))
        return selects(lambda word: by_path(word) if "/" in word else by_name(word))

    return selected


def _finder_settings(from_speed: str, to_speed: str, standstill: float) -> service_log.FinderSettings:
    with rejected("--to"):
        lowest = float(yaml.parse_quantity(to_speed, "speed"))
        if lowest < 0.0:
            raise ValueError(f"{to_speed}: a speed is not negative")
    with rejected("--from"):
        least = float(yaml.parse_quantity(from_speed, "speed"))
        if least <= max(lowest, standstill):
            raise ValueError(f"{from_speed}: write a higher speed than that at which a stop ends")
    return service_log.FinderSettings(least, lowest)


def _found_stops(
    paths: Sequence[Path], mapped: field_data.ChannelMap, settings: service_log.FinderSettings, folder: Path
) -> tuple[service_log.Log, dict[Path, str]]:
    """Find and write the stops. Raises InvalidInputError where a file cannot be read."""
    real = os.path.realpath(folder)
    if inside := next((path for path in paths if path.resolve().is_relative_to(real)), None):
        raise runs.InvalidInputError(
            f"{inside}: lies in {folder}, which the stops replace: name another folder with --recordings"
        )
    try:
        in_log = service_log.find_stops(paths, mapped, settings)
        return in_log, service_log.write_stops(in_log, mapped, folder)
    except (formats.UnreadableError, formats.MissingExtraError, field_data.MapError) as error:
        raise runs.InvalidInputError(str(error)) from error
    except file_system.FolderInUseError as error:
        raise runs.InvalidInputError(str(error)) from error
    except file_system.ForeignFileError as error:
        changed = "uictest did not write it, or it has changed"
        raise runs.InvalidInputError(
            f"{folder}: {error}: {changed}: name another folder with --recordings"
        ) from error
    except (file_system.WriteError, formats.ReadingInterruptedError):
        raise  # no errors of the recordings
    except OSError as error:
        raise runs.InvalidInputError(f"{error.filename}: {error.strerror or error}") from error


def _canonical_map(mapped: field_data.ChannelMap) -> field_data.ChannelMap:
    """Return the map of the stops that were cut out: canonical names, prepared as the log's map says.

    Each states its brake command.
    """
    names = ("time", *field_data.CHANNEL_UNITS)
    channels = {name: field_data.ChannelSource(source=(name,)) for name in names}
    return mapped.model_copy(update={"channels": channels, "time": None}).triggered_by("auto")


def _write_events(in_log: service_log.Log) -> None:
    """Write to stderr what was passed over, and what is unusual about stops."""
    for event in in_log.passed_over:
        message(f"uictest: passed over: {_passed_over_sentence(event)}")
    for number, event in enumerate(in_log.stops, start=1):
        if event.remarks:
            message(f"uictest: stop-{number:04d}: {_location_text(event)}: {'; '.join(event.remarks)}")
    message(f"uictest: {report.counted(len(in_log.stops), 'stop')}, {len(in_log.passed_over)} passed over")


def _passed_over_sentence(event: service_log.LoggedEvent) -> str:
    return f"{_location_text(event)}: {event.reason}"


def _location_text(event: service_log.LoggedEvent) -> str:
    time = service_log.clock_text(event.time)
    return f"{event.file} at {time} (sample {event.row + 1}, {event.distance:.0f} m)"
