"""Load and select cases, simulate one stop, read recordings and the results of earlier runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from uictest import report, rig, runs
from uictest.api.arguments import (
    Assignments,
    PathName,
    Trusted,
    as_paths,
    checked_seed,
    expression_of,
    override_texts,
    sample_interval,
)
from uictest.api.results import Results
from uictest.core import recording
from uictest.plans import scenario, series
from uictest.running import campaign


def load(
    *paths: PathName,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    select: str | None = None,
    tag: str | None = None,
    trust: Trusted = (),
) -> tuple[scenario.Case, ...]:
    """Load the cases of scenario files.

    Args:
        paths: scenario files or folders [default: `scenarios`]; series in folders are left out.
        set: dotted key -> value in every scenario: a text as in a file (`90 %`), a number where a key is a
            pure number, or a list of them, which becomes an axis.
        seed: seed of sensor noise and random rails in every case, 0 to 2^32 - 1.
        select: expression over ids, file names and tags, as `-k`.
        tag: expression over tags, as `-m`.
        trust: folders that scenarios may refer to, besides their own and the working folder.

    Returns:
        The cases in the order of `uictest list`; ids are unique.

    Raises:
        uictest.ScenarioErrors: files are invalid, or a key of `set`; the message has every error in it.
        ValueError: nothing is selected, or an argument is invalid.

    """
    texts, folders = override_texts(set), as_paths(trust)
    places = runs.scenario_paths(as_paths(paths))
    for path in places:
        if runs.is_series(path):
            raise ValueError(f"{path} is a series: uictest.run judges its stops together")
        if runs.is_programme(path):
            raise ValueError(f"{path} is a programme: uictest.run judges its tests")
    cases = runs.load_cases(places, texts, checked_seed(seed), folders)
    return tuple(selected(cases, (), select, tag)[0])


def selected(
    cases: Sequence[scenario.Case], planned: Sequence[series.Series], select: str | None, tag: str | None
) -> tuple[list[scenario.Case], list[series.Series]]:
    """Return the selected cases and series. Raises ValueError where there are none."""
    with expression_of("select", select):
        chosen, of_series = campaign.selected(cases, select), campaign.selected(planned, select)
    with expression_of("tag", tag):
        chosen, of_series = campaign.selected(chosen, tag=tag), campaign.selected(of_series, tag=tag)
    if not (chosen or of_series):
        raise ValueError(runs.nothing_selected(cases, planned))
    return chosen, of_series


def simulate(
    what: PathName | scenario.Case,
    *,
    case: str | None = None,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    trust: Trusted = (),
    record: float = 100.0,
) -> recording.Recording:
    """Simulate one stop and return its channels over time; nothing is judged.

    Args:
        what: scenario file, or a case from :func:`uictest.load`.
        case: id of the case, where the file has several.
        set: dotted key -> value, as for :func:`uictest.load`; for files.
        seed: seed of sensor noise and random rails, 0 to 2^32 - 1 [default: the scenario's].
        trust: folders that the scenario may refer to, besides its own and the working folder.
        record: samples per second, 1 to 100000.

    Returns:
        The recording: time in s since the brake command, units of every channel in `units`. Of a case that
        repeats its stop, the first.

    Raises:
        uictest.ScenarioErrors: the file is invalid, or a key of `set`; the message has every error in it.
        ValueError: no such case, or several and none is named; or an argument is invalid.
        uictest.controllers.ControllerError: a controller from outside failed.

    """
    every = sample_interval("record", record)
    stop = rig.simulate(_case(what, case, set, checked_seed(seed), as_paths(trust)), every)
    assert stop.recording is not None  # a rate is requested
    return stop.recording


def _case(
    what: PathName | scenario.Case,
    case: str | None,
    assignments: Assignments | None,
    seed: int | None,
    trusted: list[Path],
) -> scenario.Case:
    texts = override_texts(assignments)
    if not isinstance(what, scenario.Case):
        return scenario.chosen_case(runs.load_cases([Path(what)], texts, seed, trusted), case)
    if texts or trusted or case is not None:
        raise ValueError("case, set and trust apply to files: pass set and trust to uictest.load")
    if seed is None:
        return what
    return what.with_values(seed=seed)


_AS_WRITTEN = "uictest"


def read_recording(
    file: PathName, channel_map: PathName = _AS_WRITTEN, *, trust: Trusted = ()
) -> recording.Recording:
    """Read a recording: Parquet, CSV, MDF, TDMS or MAT.

    Args:
        file: file of the recording.
        channel_map: `uictest` for a file with channels as this program names them: all of them, as they are;
            else a preset or a YAML file, and the stop in the recording is returned as
            :func:`uictest.evaluate` judges it: SI units, evenly sampled from brake command to standstill.
        trust: folders that the channel map may refer to, besides its own and the working folder.

    Raises:
        ValueError: the file cannot be read as a recording, or there is no such channel map.
        uictest.ScenarioErrors: the channel map is invalid.

    """
    path = Path(file)
    if str(channel_map) == _AS_WRITTEN:
        return runs.each_file([path], runs.read_recording)[0]
    mapped, _ = runs.named_map(str(channel_map), as_paths(trust))
    stop = runs.each_file([path], lambda file: runs.read_stop(file, mapped))[0]
    facts = {**stop.choices, "defects": "; ".join(map(str, stop.defects)) or "none"}
    samples = stop.recording
    return recording.Recording(samples.channels, samples.units, {**samples.metadata, **facts})


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
