"""Read recordings and the results of earlier runs."""

from __future__ import annotations

from pathlib import Path

from uictest import report, runs
from uictest.api.arguments import PathName, Trusted, as_paths
from uictest.api.results import Results
from uictest.core import recording
from uictest.core.recording import formats
from uictest.recorded import field_data

_AS_WRITTEN = "uictest"


def read_recording(
    file: PathName, channel_map: PathName = _AS_WRITTEN, *, trust: Trusted = ()
) -> recording.Recording:
    """Read a recording: Parquet, CSV, MDF, TDMS or MAT.

    Args:
        file: of the recording.
        channel_map: `uictest` for a file with channels as this program names them: all of them, as they are;
            else a preset or a YAML file, and the stop in the recording is returned as
            :func:`uictest.evaluate` judges it: SI units, an even raster from the brake command to standstill.
        trust: folders that the channel map may refer to, besides its own and the working folder.

    Raises:
        ValueError: the file cannot be read as a recording, or there is no such channel map.
        uictest.ScenarioErrors: the channel map is invalid.

    """
    path = Path(file)
    if str(channel_map) != _AS_WRITTEN:
        mapped, _ = runs.named_map(str(channel_map), as_paths(trust))
        return runs.each_file([path], lambda each: _stop(each, mapped))[0]
    return runs.each_file([path], _as_written)[0]


def _as_written(path: Path) -> recording.Recording:
    if path.suffix == ".parquet":
        try:
            return recording.read_parquet(path)
        except ValueError as error:
            raise formats.UnreadableError(str(error)) from error
    return recording.recording_of(formats.read_contents(path), {"source": path.name})


def _stop(path: Path, channel_map: field_data.ChannelMap) -> recording.Recording:
    try:
        stop = field_data.stop_in(path, channel_map)
    except field_data.UnusableError as error:
        raise formats.UnreadableError(str(error)) from error
    facts = {**stop.choices, "defects": "; ".join(map(str, stop.defects)) or "none"}
    channels, units = stop.recording.channels, stop.recording.units
    return recording.Recording(channels, units, {**stop.recording.metadata, **facts})


def read_results(place: PathName) -> Results:
    """Read the results of an earlier run.

    Args:
        place: folder of the run, its results.json, or `latest` in the folder of all runs.

    Raises:
        OSError: the results cannot be read.
        ValueError: they are not those of a run.

    """
    path = Path(place)
    folder = path.parent if path.name == report.RESULTS else runs.run_folder(path)
    return Results(report.read_run(folder), folder=folder)
