"""Find, load and select the cases, the series and the validations that paths name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from uictest import report
from uictest.analysis import validation
from uictest.plans import library, scenario, series
from uictest.plans.scenario import yaml
from uictest.running import campaign

_DEFAULT_FOLDER = Path("scenarios")


def scenario_paths(paths: Sequence[Path] | None) -> list[Path]:
    """Return the given paths, names of shipped scenarios turned into paths; else the default folder.

    Raises InvalidInputError where that is missing.
    """
    if paths:
        return [library.named_scenario(path) for path in paths]
    if not _DEFAULT_FOLDER.is_dir():
        raise InvalidInputError(
            f"there is no folder {_DEFAULT_FOLDER}/ here: name scenario files or folders, or a scenario that "
            "ships with uictest, such as slip-120 ('uictest init --scenarios' copies all), "
            "or make a first scenario with 'uictest init'"
        )
    return [_DEFAULT_FOLDER]


def load_cases(
    paths: Sequence[Path] | None,
    overrides: Sequence[str] | None = None,
    seed: int | None = None,
    trusted: Sequence[Path] | None = None,
) -> list[scenario.Case]:
    """Return all cases of the scenarios. Series among the paths are left to :func:`load_series`.

    Raises ScenarioErrors with every diagnostic of every file, and InvalidInputError.
    """
    named = [path for path in scenario_paths(paths) if not is_series(path)]
    return scenario.load(named, tuple(overrides or ()), seed, trusted or ()) if named else []


def load_cases_and_series(
    paths: Sequence[Path] | None,
    overrides: Sequence[str] | None = None,
    seed: int | None = None,
    trusted: Sequence[Path] | None = None,
) -> tuple[list[scenario.Case], list[series.Series]]:
    """Return all cases and all series, or those of a programme; errors of neither hide those of the others.

    Raises ScenarioErrors, and InvalidInputError as :func:`load_series`.
    """
    named = scenario_paths(paths)
    if (programme := load_programme(named, overrides or (), seed, trusted)) is not None:
        return programme.cases, []
    cases: list[scenario.Case] = []
    planned: list[series.Series] = []
    diagnostics: list[yaml.Diagnostic] = []
    try:
        cases = load_cases(named, overrides, seed, trusted)
    except yaml.ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    try:
        planned = load_series(list(series_files(named)), overrides, seed, trusted)
    except yaml.ScenarioErrors as errors:
        diagnostics.extend(errors.diagnostics)
    if diagnostics:
        raise yaml.ScenarioErrors(diagnostics)
    return cases, planned


def is_series(path: Path) -> bool:
    """Return whether a path names a series file."""
    return path.name.endswith(scenario.SERIES_SUFFIXES)


def is_programme(path: Path) -> bool:
    """Return whether a path names a programme file."""
    return path.name.endswith(scenario.PROGRAMME_SUFFIXES)


def load_programme(
    paths: Sequence[Path] | None, overrides: Sequence[str], seed: int | None, trusted: Sequence[Path] | None
) -> series.Programme | None:
    """Return the programme that paths name, None where none of them does.

    Raises InvalidInputError where it is not alone, and ScenarioErrors.
    """
    named = [library.named_scenario(path) for path in paths or ()]
    if not any(map(is_programme, named)):
        return None
    if len(named) > 1:
        raise InvalidInputError("a programme is run alone: name no other file beside it")
    return series.load_programme(named[0], overrides, seed, trusted or ())


def is_sweep(path: Path) -> bool:
    """Return whether a path names a sweep file."""
    return path.name.endswith(scenario.SWEEP_SUFFIXES)


def series_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the series files among the paths, and those below folders that are not hidden, each once."""
    return _files_matching(paths, "*.series.y*ml", is_series)


def sweep_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the sweep files among the paths, and those below folders that are not hidden, each once."""
    return _files_matching(paths, "*.sweep.y*ml", is_sweep)


def programme_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Yield the programme files among the paths, and those below folders that are not hidden, each once."""
    return _files_matching(paths, "*.programme.y*ml", is_programme)


def _files_matching(paths: Sequence[Path], pattern: str, is_one: Callable[[Path], bool]) -> Iterator[Path]:
    seen: set[Path] = set()
    for path in paths:
        files = [path]
        if path.is_dir():
            below = (file.relative_to(path) for file in sorted(path.rglob(pattern), key=Path.as_posix))
            files = [path / file for file in below if not any(part.startswith(".") for part in file.parts)]
        for file in filter(is_one, files):
            if file.absolute() not in seen:
                seen.add(file.absolute())
                yield file


def load_series(
    paths: Sequence[Path],
    overrides: Sequence[str] | None = None,
    seed: int | None = None,
    trusted: Sequence[Path] | None = None,
) -> list[series.Series]:
    """Return all series of the files.

    Raises ScenarioErrors with every diagnostic of every file, and InvalidInputError where two have one id.
    """
    loaded: list[series.Series] = []
    diagnostics: list[yaml.Diagnostic] = []
    for path in paths:
        with yaml.collecting(diagnostics, yaml.whole_file(path)):
            loaded += series.load_series(path, tuple(overrides or ()), seed, trusted or ())
    if diagnostics:
        raise yaml.ScenarioErrors(diagnostics)
    files: dict[str, Path] = {}
    for planned in loaded:
        if planned.id in files:
            where = f"{planned.path} and {files[planned.id]}"
            raise InvalidInputError(
                f"a second series {planned.id!r} in {where}: give every series a name of its own"
            )
        files[planned.id] = planned.path
    return loaded


def nothing_selected(cases: Sequence[scenario.Case], planned: Sequence[series.Series] = ()) -> str:
    """Return the message for an empty selection, with the number of cases and series and their tags."""
    if not (cases or planned):
        return "nothing selected: no scenario in what was given (*.yaml, *.yml)"
    of_series = {tag for one in planned for tag in one.file.tags}
    tags = sorted({tag for case in cases for tag in case.scenario.tags} | of_series)
    among = f"{report.counted(len(cases), 'case')}{f' and {len(planned)} series' if planned else ''}"
    return f"nothing selected among {among}; their tags: {', '.join(tags) or 'none'}"


def only_case(
    path: Path,
    expression: str | None,
    overrides: Sequence[str],
    trusted: Sequence[Path] | None,
    how: str = "choose with -k",
) -> scenario.Case:
    """Return the one case of a scenario file; `how` says how to choose one.

    Raises InvalidInputError where there are several or none, ScenarioErrors, ExpressionError.
    """
    cases = campaign.selected(load_cases([path], overrides, None, trusted), expression)
    if len(cases) != 1:
        ids = ", ".join(case.id for case in cases[:8]) or "none is selected"
        raise InvalidInputError(f"{path} has {len(cases)} cases where one is needed ({ids}); {how}")
    return cases[0]


def reference_of(option: Path | None, named: str | None) -> validation.ValidationReference | None:
    """Return the validation of an option, else that which a scenario names. Raises InvalidInputError."""
    path = option or (None if named is None else Path(named))
    return None if path is None else read_reference(path)


def references_of(
    cases: Sequence[scenario.Case], validated: Path | None
) -> dict[str, validation.ValidationReference]:
    """Return the validation of each case that has one, by its id; each file is read once."""
    named = {case.id: validated or case.scenario.validated for case in cases}
    read = {path: read_reference(Path(path)) for path in dict.fromkeys(named.values()) if path is not None}
    return {case_id: read[path] for case_id, path in named.items() if path is not None}


def read_reference(path: Path) -> validation.ValidationReference:
    """Return the validation that cases are held against. Raises InvalidInputError."""
    try:
        return validation.read_validation(path)
    except OSError as error:
        raise InvalidInputError(f"{path}: {error.strerror or error}") from error
    except ValueError as error:
        raise InvalidInputError(f"{path}: {error}") from error


class InvalidInputError(ValueError):
    """Arguments or files that cannot be used; each message says what is wrong and what to do instead.

    Args:
        messages: complete, in the words of any caller.
        arguments: those that the caller can change, by name; a command shows the options that set them.
    """

    def __init__(self, *messages: str, arguments: Sequence[str] = ()) -> None:
        self.messages = messages
        self.arguments = tuple(arguments)
        super().__init__(*messages)

    def __str__(self) -> str:
        return "\n".join(self.messages)


def implausible_trains(cases: Iterable[scenario.Case]) -> list[yaml.Diagnostic]:
    """Return a diagnostic for each derived quantity beyond its span, once for all cases that share it."""
    figures = dict.fromkeys(
        (case.path, figure) for case in cases for figure in scenario.car_figures(case.scenario).implausible
    )
    return [
        yaml.diagnose(place, str(figure), key, figure.likely)
        for path, figure in figures
        for place, key in [_first_set(path, figure.keys)]
    ]


def place_of_key(path: Path, key: str) -> yaml.Location | None:
    """Return the location of a key in a scenario file or a file that it refers to; None without one."""
    path = library.named_scenario(path)
    node: yaml.Node | None = yaml.read_file(path)
    names = key.split(".")
    for depth, name in enumerate(names):
        inner = node.get(name) if isinstance(node, yaml.Map) else None
        if inner is None:
            reference = node.get("extends") if isinstance(node, yaml.Map) else node
            if not isinstance(reference, yaml.Scalar) or not scenario.is_path(reference.text):
                return None
            return place_of_key(path.parent / reference.text, ".".join(names[depth:]))
        node = inner
    return None if node is None else node.location


def _first_set(path: Path, keys: Sequence[str]) -> tuple[yaml.Location, str]:
    """Return the first of some keys that is set, and where; without any the first key and the whole file."""
    for key in keys:
        if (place := place_of_key(path, key)) is not None:
            return place, key
    return yaml.whole_file(path), keys[0]
