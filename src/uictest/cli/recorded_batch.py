"""Recordings from file to the published reports."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from uictest import field_data, recording, report, scenario
from uictest.campaign import BatchResult, CaseRun, RecordingRequest
from uictest.cli.display import Display
from uictest.cli.recordings import each_file, names_of
from uictest.cli.streams import message
from uictest.scenario import yaml
from uictest.units import KILOMETRE_PER_HOUR

Stated = Callable[[str, float], "scenario.Case"]
"""The case that a stop is judged as: from its name and its initial speed, m/s."""
_UNKNOWN_SPEED = 120.0 * KILOMETRE_PER_HOUR
"""m/s, for the scenario of a record whose speed cannot be used: its result is an error whatever it says."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A recording, its name in the reports, and the stop in it; only defects where it cannot be used."""

    path: Path
    name: str
    digest: str
    stop: field_data.RecordedStop | None
    defects: tuple[field_data.Defect, ...]

    def case(self, stated: Stated, inputs: dict[str, str]) -> scenario.Case:
        """Return what this recording is judged as."""
        speed = _UNKNOWN_SPEED if self.stop is None else float(self.stop.recording["speed"][0])
        base = stated(self.name, speed)
        shown = yaml.display_name(self.path)
        return replace(
            base, id=self.name, path=Path(shown), inputs={**base.inputs, **inputs, shown: self.digest}
        )


def read_all(files: Sequence[Path], channel_map: field_data.ChannelMap) -> list[Measured]:
    """Read every file. Raises InvalidInputError with the errors of all that are no recordings."""

    def read(named: Path) -> Measured:
        try:
            stop = field_data.stop_in(named, channel_map)
        except field_data.UnusableError as error:
            return Measured(named, "", field_data.digest_of(named), None, error.defects)
        return Measured(named, "", field_data.digest_of(named), stop, stop.defects)

    read_ones = each_file(files, read)
    return [replace(each, name=name) for each, name in zip(read_ones, names_of(files), strict=True)]


def judge_all(recordings: Sequence[Measured], cases: Sequence[scenario.Case]) -> list[CaseRun]:
    """Judge every stop; the samples it was judged by come with its result."""
    examined = []
    for measured, case in zip(recordings, cases, strict=True):
        if measured.stop is None:
            examined.append(CaseRun(field_data.unusable_result(case, measured.defects)))
            continue
        examined.append(CaseRun(*field_data.judge_recording(case, measured.stop)))
    return examined


def subjects_of(
    recordings: Sequence[Measured], cases: Sequence[scenario.Case]
) -> dict[str, report.CaseDescription]:
    """Return what the stops are about, by the id of the case each is judged as."""
    return {
        case.id: field_data.recorded_description(case, measured.stop)
        for measured, case in zip(recordings, cases, strict=True)
    }


def traces_of(examined: Sequence[CaseRun]) -> dict[str, report.Trace]:
    """Return what there is to draw of the recordings, by the id of the case each is judged as."""
    return {
        each.result.id: report.trace_of(each.recording, each.result.criteria)
        for each in examined
        if each.recording is not None
    }


def publish(
    examined: Sequence[CaseRun],
    wish: RecordingRequest,
    manifest: report.RunManifest,
    output: Path,
    junit: Path | None,
    display: Display,
    subjects: Mapping[str, report.CaseDescription],
    traces: Mapping[str, report.Trace],
) -> tuple[BatchResult, Path]:
    """Write the reports of a run of recordings; return its results and where they are. Raises OSError.

    `wish` says whose samples are kept, `subjects` what the cases are about and `traces` what the page draws
    of them, by id.
    """
    results = [each.result for each in examined]
    with report.RunFolder(output, report.run_name(datetime.now(UTC), manifest)) as folder:
        for each in examined:
            if each.recording is not None and wish.wants(each.result):
                report.write_recording(folder.path, each.result.id, each.recording)
        content = report.RunContent(folder.name, results, manifest, True, subjects, traces)
        document = report.write_reports(folder.path, content)
        report.write_formats(folder.path, content, ["html"])
        place = folder.publish()
    report.point_latest(place)
    if junit is not None:
        recording.write_text_atomic(junit, report.junit_xml(results))
    for result in results:
        display.case(result)
    display.end(content, document)
    return BatchResult(results), place


def tell(recordings: Sequence[Measured]) -> None:
    """Say how each record was prepared and everything that was found wrong with it."""
    for measured in recordings:
        if measured.stop is not None:
            chosen = "; ".join(f"{name}: {text}" for name, text in measured.stop.choices.items())
            message(f"uictest: {measured.path}: {chosen}")
        for defect in measured.defects:
            message(f"uictest: {measured.path}: {defect}")
