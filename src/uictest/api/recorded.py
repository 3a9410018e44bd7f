"""`uictest.evaluate` and `uictest.validate`: recorded stops, judged and held against their simulation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from uictest import report, runs
from uictest.analysis import validation
from uictest.api.arguments import (
    Assignments,
    PathName,
    Record,
    Trusted,
    as_paths,
    command_words,
    expression_of,
    override_texts,
    recording_request,
    thread_count,
)
from uictest.api.results import Results, frame_of
from uictest.core import recording
from uictest.plans import scenario as scenarios
from uictest.running import campaign

if TYPE_CHECKING:
    import pandas as pd


_ARGUMENTS = {
    "rail.condition": "rail",
    "brake.position": "position",
    "rig.wsp": "wsp",
    "criteria": "criteria",
}
"""Key that must be stated for a recording -> the argument that states it."""
_FORMATS = ("html",)
DEFAULT_MAP = "uictest"


def evaluate(
    files: PathName | Iterable[PathName],
    *,
    scenario: PathName | scenarios.Case | None = None,
    select: str | None = None,
    criteria: str | Sequence[str] | None = None,
    rail: str | None = None,
    position: str | None = None,
    wsp: str | None = None,
    channel_map: PathName = DEFAULT_MAP,
    trigger: str | None = None,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    trust: Trusted = (),
    record: Record = "failed",
    strict: bool = False,
    output: PathName | None = None,
) -> Results:
    """Judge recordings of real or simulated stops: the same digits as `uictest evaluate`.

    A recording does not contain what was tested: state it with `scenario`, or with `criteria`, `rail`,
    `position` and `wsp`.

    Args:
        files: recordings; or `*.series.yaml` files whose stops name recordings.
        scenario: file with the test conditions and the criteria, or a case from :func:`uictest.load`.
        select: expression that selects one case of the scenario file, as `-k`.
        criteria: names of criteria to judge by, one or several.
        rail: rail condition, such as `wet`.
        position: brake position, such as `R`.
        wsp: `active` or `bypassed`.
        channel_map: a preset or a YAML file.
        trigger: the brake command, as `--trigger`: `auto`, `start`, ... or a time such as `12.3 s`.
        set: dotted key -> value, as for :func:`uictest.load`.
        trust: folders that files may refer to, besides their own and the working folder.
        record: samples that `output` gets: of stops `failed` (not as expected), of `all` or `none`.
        strict: whether a stop is met only if all of its verdicts are settled, too, as `--strict`.
        output: folder for reports; the run gets a folder in it, as with `-o`.

    Returns:
        One result per recording, named after its file; :meth:`Results.recording` has the samples that it was
        judged by.

    Raises:
        uictest.ScenarioErrors: the scenario, the channel map or the series is invalid.
        ValueError: a recording cannot be read, a statement is missing, or an argument is invalid.
        OSError: reports cannot be written.

    """
    paths, folders, request = as_paths(files), as_paths(trust), recording_request(record)
    if not paths:
        raise ValueError("nothing to evaluate: name recordings")
    names = [criteria] if isinstance(criteria, str) else criteria
    listed = f"[{', '.join(names)}]" if names else None
    stated = {"rail.condition": rail, "brake.position": position, "rig.wsp": wsp, "criteria": listed}
    statements = [f"{key}={text}" for key, text in stated.items() if text is not None]
    overrides = override_texts(set)
    options = {
        "--scenario": scenario.path if isinstance(scenario, scenarios.Case) else scenario,
        "-k": select,
        "--set": [*statements, *overrides],
        "--trust": folders,
        "--map": None if channel_map == DEFAULT_MAP else channel_map,
        "--trigger": trigger,
        "--record": None if record == "failed" else record,
        "-o": output,
    }
    words = command_words(["evaluate", *paths, *(["--strict"] if strict else [])], options)
    if any(map(runs.is_series, paths)):
        runs.require_nothing_stated((scenario, select, *statements, trigger), "set")
        stops = runs.stops_of_series(paths, overrides, folders)
    else:
        case_of = _case_of(scenario, select, [*statements, *overrides], folders)
        mapped, inputs = runs.named_map(str(channel_map), folders)
        stops = runs.stops_in_recordings(paths, mapped.triggered_by(trigger), inputs, case_of)
    batch = runs.recorded_batch(stops, words, campaign.RecordingRequest("all"), strict=strict)
    recordings: dict[str, recording.Recording] = {}
    content = runs.run_batch(batch, runs.Observer(), draws_stops=True, keep=recordings.__setitem__).content
    if output is None:
        return Results(content, recordings=recordings)
    wanted = request.among(recordings, content.all_results)
    published = runs.publish_run(content, wanted, Path(output), _FORMATS)
    return Results(published.content, recordings=recordings, folder=published.place)


def _case_of(
    scenario: PathName | scenarios.Case | None,
    select: str | None,
    statements: Sequence[str],
    trusted: Sequence[Path],
) -> runs.CaseOfStop:
    """Return the function that makes the case of a recording. Raises ValueError."""
    if isinstance(scenario, scenarios.Case):
        if statements or select is not None:
            raise ValueError("a case is judged as it is: state its conditions in uictest.load")
        return lambda name, speed: scenario
    case = None
    if scenario is not None:
        with expression_of("select", select):
            case = runs.only_case(Path(scenario), select, statements, trusted, "choose with select=")
    return runs.case_of_stop(
        case,
        statements,
        trusted,
        lambda keys: f"scenario=, or with {', '.join(f'{_ARGUMENTS[key]}=' for key in keys)}",
    )


class Validation:
    """Recorded stops and their simulation: how far off the model is, and where that has been shown.

    Attributes:
        result: what validation.json has: stops, figures, domains.
        complete: whether every simulation came to an end.
        folder: folder of the files, absolute; None where none were written.
    """

    def __init__(self, result: validation.Validation, *, complete: bool, folder: Path | None) -> None:
        """Made by :func:`uictest.validate`."""
        self.result = result
        self.complete = complete
        self.folder = None if folder is None else folder.absolute()

    def __len__(self) -> int:
        """Return the number of recorded stops, counted or not."""
        return len(self.result.stops)

    @property
    def met(self) -> bool:
        """Whether every simulation ended, and every stop counts that is not marked as tuned."""
        return self.complete and not self.result.not_usable

    @property
    def tally(self) -> str:
        """How many of the recorded stops count, in words."""
        return validation.tally(self.result)

    @property
    def file(self) -> Path | None:
        """The file that `validated` takes; None where none was written."""
        return None if self.folder is None else self.folder / validation.RESULT

    def frame(self) -> pd.DataFrame:
        """Return one row per figure, index `figure`: the columns of figures.csv.

        `bias`, `deviation` and their intervals are in the `unit` of the row, `relative_...` are shares of the
        recorded figure. NaN is what the stops cannot show.
        """
        return frame_of(validation.figures_table(self.result), ("figure",))

    def stops(self) -> pd.DataFrame:
        """Return one row per stop and figure: recorded, simulated and their difference, as in stops.csv.

        A stop that cannot be used has one row without figure.
        """
        return frame_of(validation.stops_table(self.result), ("stop", "figure"))

    def __repr__(self) -> str:
        """Return the counts, the figures and the domain, as `uictest validate` prints them."""
        document = validation.validation_document(self.result, every_figure=False)
        lines = report.document_lines(document, None)
        return "\n".join([f"{self.result.name}: {self.tally}", *lines])

    def _repr_html_(self) -> str:
        shown = ["unit", "stops", "recorded_mean", "bias", "deviation", "limits_low", "limits_high"]
        table = self.frame()[shown].to_html(float_format="{:.5g}".format, na_rep="-")
        return f"<p>{escape(self.result.name)}: {escape(self.tally)}</p>{table}"


def validate(
    file: PathName,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    output: PathName | None = None,
) -> Validation:
    """Compare recorded stops with their simulation: the same digits as `uictest validate`.

    Nothing is printed, and nothing is written unless `output` names a folder.

    Args:
        file: a validation file, or a `*.series.yaml` whose stops name recordings.
        set: dotted key -> value in every scenario, as for :func:`uictest.load`.
        trust: folders that files may refer to, besides their own and the working folder.
        jobs: number of threads, `auto`: one for each processor.
        output: folder for validations; this one gets a folder in it, as with `-o`.

    Raises:
        uictest.ScenarioErrors: the file is invalid, one that it names, or a key of `set`.
        ValueError: a recording cannot be read, no stop names one, the file has several series, or an argument
            is invalid.
        OSError: the files of the validation cannot be written.

    """
    threads, texts, folders = thread_count(jobs), override_texts(set), as_paths(trust)
    plan, *others = runs.load_validations([Path(file)], texts, folders)
    if others:
        names = ", ".join(one.name for one in (plan, *others))
        raise ValueError(f"{file}: each series is a validation of its own, found {names}: name a file of one")
    run = runs.run_validation(plan, threads, folders, runs.Observer())
    folder = None
    if output is not None:
        words = command_words(["validate", file], {"--set": texts, "--trust": folders, "-o": output})
        folder = runs.publish_validation(run, words, Path(output))
    return Validation(run.validation, complete=run.complete, folder=folder)
