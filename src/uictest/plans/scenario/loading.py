"""From files to cases, and from names on a command line to parts."""

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.plans.scenario.case import (
    CAR,
    CONTROLLER,
    EXPECT,
    LONGEST,
    Case,
    Labels,
    TrainPlace,
    case_id,
    controller_labels,
    duplicate_id,
    sets_controller,
    short_keys,
    with_another_controller,
)
from uictest.plans.scenario.expansion import EXPANSION_KEYS, Variant, distinct, expand_valid
from uictest.plans.scenario.overrides import (
    OF_CAR,
    Override,
    apply_overrides,
    changed_alone,
    overridden_alone,
    parse_overrides,
    with_value,
)
from uictest.plans.scenario.parts.controller import ControllerPart
from uictest.plans.scenario.programs import KIND_OF_ENDING, SOCKET
from uictest.plans.scenario.resolution import (
    PART_KEYS,
    PART_KINDS,
    Parts,
    folder_of,
    is_path,
    with_default_parts,
)
from uictest.plans.scenario.train import (
    is_older,
    is_train,
    reaching_no_car,
    resolved_cars,
    with_default_vehicles,
    without_inherited_vehicle,
)
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    SCENARIO_SCHEMA,
    Diagnostic,
    Document,
    Entry,
    Files,
    Location,
    Map,
    Part,
    Roots,
    Scalar,
    ScenarioErrors,
    as_written,
    collecting,
    display_name,
    inherit,
    is_file,
    is_null,
    quoted,
    require_none,
    require_schema,
    scenario_trees,
    single_error,
    unreadable_error,
    whole_file,
)

_SECTIONS_OF_SWEEPS: Final = ("grid", "ranges", "sample")
"""Keys that a scenario has only under `vary`, and `grid`, which 0.2 had for `matrix`."""


class LoadedCase(NamedTuple):
    """A case and the tree that it is resolved from; `vary` is what a sweep of it varies.

    Of a car that a sweep varies, the tree is that of its train. `search` is the section of that name, which
    says nothing of the case; `written` what its file and the parents of it say, without the command line.
    """

    case: Case
    tree: Map
    vary: Entry | None = None
    search: Entry | None = None
    written: Map | None = None


def load(
    paths: Sequence[Path],
    overrides: Sequence[str] = (),
    seed: int | None = None,
    trusted: Sequence[Path] = (),
) -> list[Case]:
    """The cases of every scenario file at or below ``paths``.

    ``overrides`` are ``key=value`` texts; comma lists and ``range(first,last,step)`` become axes of the
    matrix. ``seed`` takes the place of every scenario's own. References stay at or below the folders of
    ``paths``, the working folder and the ``trusted`` folders. Raises ScenarioErrors with all errors of all
    files.
    """
    parsed = parse_overrides(overrides, seed)
    loader = _Loader(Parts(Files(Roots.of(paths, trusted))), parsed)
    cases = [
        loaded.case
        for path, tree in scenario_trees(paths, loader.parts.files, loader.diagnostics)
        for loaded in loader.loaded(path, tree)
    ]
    require_none(loader.diagnostics)
    return cases


def load_file(path: Path, overrides: Sequence[Override], files: Files) -> list[Case]:
    """The cases of one scenario file, read by `files`. Raises ScenarioErrors with all errors of it."""
    return [each.case for each in load_with_trees(path, overrides, Parts(files))]


def load_with_trees(
    path: Path, overrides: Sequence[Override], parts: Parts, *, varied: bool = False
) -> list[LoadedCase]:
    """As :func:`load_file`, each case with its tree; parts are resolved by `parts`.

    With `varied`, the file says under `vary` what a sweep varies: it has one case, and lists of cases that it
    inherits do not count.
    """
    loader = _Loader(parts, tuple(overrides), varied=varied)
    loaded = list(loader.loaded(path, parts.files.at(path)))
    require_none(loader.diagnostics)
    return loaded


class _ScenarioFile(NamedTuple):
    """One scenario file: what its cases share, and the case of every id."""

    path: Path
    written: Map
    tree: Map
    documents: tuple[Document, ...]
    short: dict[str, str]
    labels: Labels
    vary: Entry | None
    search: Entry | None
    ids: dict[str, Variant]
    inherits_expectation: bool
    """Whether it stands in a parent of the file that names the controller."""


class _Loader:
    """Loads one scenario after another and collects the errors of all."""

    def __init__(self, parts: Parts, overrides: tuple[Override, ...], *, varied: bool = False) -> None:
        self.parts = parts
        self.overrides = overrides
        self.varied = varied
        self.diagnostics: list[Diagnostic] = []
        self.file_of_id: dict[str, _ScenarioFile] = {}

    def loaded(self, path: Path, tree: Map) -> Iterator[LoadedCase]:
        """Yield the cases of one file with their trees, as far as they are without errors."""
        file, variants = None, list[Variant]()
        with collecting(self.diagnostics, whole_file(path)):
            file, variants = self._read(path, tree)
        for variant in variants if file is not None else ():
            cases = list[LoadedCase]()
            with collecting(self.diagnostics, whole_file(path)):
                cases = self._cases(file, variant)
            yield from cases

    def _read(self, path: Path, tree: Map) -> tuple[_ScenarioFile, list[Variant]]:
        require_schema(tree, SCENARIO_SCHEMA)
        own_name = tree.entries.get("name")
        merged, documents = inherit(
            tree,
            fetch=self._parent,
            check=lambda parent, child: self.diagnostics.extend(changed_alone(parent, child)),
        )
        # Every scenario has its own name: an inherited one would not be unique.
        merged = merged.without("name") if own_name is None else merged.with_entry("name", own_name)
        merged, vary = self._without_vary(tree, merged)
        merged, search = _without_search(merged, vary)
        expect, controller = merged.entries.get(EXPECT), merged.entries.get(CONTROLLER)
        inherits = expect is not None and controller is not None and is_older(expect, controller, documents)
        merged = without_inherited_vehicle(merged, documents)
        merged = with_default_vehicles(merged) if is_train(merged) else with_default_parts(merged)
        self.diagnostics.extend(overridden_alone(merged, self.overrides))
        written, merged = merged, apply_overrides(merged, self.overrides)
        base = merged.without(*EXPANSION_KEYS)
        # Errors of the sweep do not hide those of its values: valid ones are checked nevertheless.
        variants = expand_valid(merged, self.diagnostics)
        if self.overrides:
            # Cases that differed only in a key that the command line sets are the same now.
            variants = distinct(variants)
        settings = [setting for variant in variants for setting in variant]
        short = short_keys(list(dict.fromkeys(setting.key for setting in settings)))
        labels = controller_labels(settings, self.parts)
        return _ScenarioFile(
            path, written, base, documents, short, labels, vary, search, {}, inherits
        ), variants

    def _without_vary(self, own: Map, merged: Map) -> tuple[Map, Entry | None]:
        """Take off what a sweep varies. Raises ScenarioErrors where the file should be none, or is none."""
        vary = merged.entries.get("vary")
        if vary is not None and is_null(vary.node):
            vary = None
        if not self.varied:
            if vary is not None:
                hint = "run it with `uictest sweep`; the name of a sweep's file ends in .sweep.yaml"
                raise single_error(vary.key, "a scenario with 'vary' is a sweep", "vary", hint)
            return merged, None
        for key in (*_SECTIONS_OF_SWEEPS, *(EXPANSION_KEYS if vary is not None else ())):
            if (entry := own.entries.get(key)) is not None:
                message = f"a sweep has no {quoted(key)} beside 'vary'"
                raise single_error(entry.key, message, key, "list what a sweep varies under `vary`")
        if vary is None:
            hint = "a scenario without `vary` is run with `uictest run`"
            raise single_error(own.location, "nothing varies", "vary", hint)
        return merged.without("vary", *EXPANSION_KEYS), vary

    def _parent(self, reference: Scalar) -> Map:
        files = self.parts.files
        tree = files.at(files.scenario_beside(reference, "extends"))
        require_schema(tree, SCENARIO_SCHEMA)
        return tree

    def _cases(self, file: _ScenarioFile, variant: Variant) -> list[LoadedCase]:
        tree = self._varied(file.tree, variant)
        cars = resolved_cars(file.path, tree, self.parts)
        given = {each.key: Entry(each.location, each.values[0]) for each in self.overrides}
        given |= {setting.key: setting.value for setting in variant}
        self.diagnostics.extend(reaching_no_car(tree, given))
        expects = any(OF_CAR.sub("", key) == EXPECT for key in given)
        if (file.inherits_expectation or sets_controller(given)) and not expects:
            cars = [((with_another_controller(own), read), car) for (own, read), car in cars]
        scenarios = tuple(scenario for (scenario, _), _ in cars)
        # What is expected is no condition of a stop.
        conditions = tuple(each for each in variant if OF_CAR.sub("", each.key) != EXPECT)
        named = scenarios[0].name, conditions, file.short, file.labels
        swept = {setting.key: as_written(setting.value.node) for setting in conditions}
        read = [*file.documents, *(document for (_, documents), _ in cars for document in documents)]
        inputs = {each.display: each.sha256 for each in read if each.sha256}
        path, is_coupled, loaded = Path(display_name(file.path)), is_train(tree), list[LoadedCase]()
        for number, ((scenario, _), car) in enumerate(cars, start=1):
            identifier = self._claimed(case_id(*named, car=number if is_coupled else 0), file, variant)
            parameters = {**swept, CAR: str(number)} if is_coupled else swept
            train = TrainPlace(case_id(*named), number, scenarios) if is_coupled else None
            case = Case(identifier, scenario, path, parameters, inputs, train)
            own = tree if self.varied else car
            loaded.append(LoadedCase(case, own, file.vary, file.search, file.written))
        return loaded

    def _varied(self, base: Map, variant: Variant) -> Map:
        tree = base
        # From the outside in, so that a part is named before something inside it is changed.
        for setting in sorted(variant, key=lambda setting: setting.key.count(".")):
            try:
                tree = with_value(tree, setting.key, setting.value)
            except ScenarioErrors as errors:
                self.diagnostics.extend(errors.diagnostics)
        self.diagnostics.extend(changed_alone(base, tree))
        return tree

    def _claimed(self, identifier: str, file: _ScenarioFile, variant: Variant) -> str:
        """The id. Raises ScenarioErrors if it is too long or another case has it."""
        name = file.tree.entries["name"].node.location
        location = variant[-1].value.node.location if variant else name
        if len(identifier) > LONGEST:
            raise single_error(
                location, f"the case id {quoted(identifier)} is longer than {LONGEST} characters", "name"
            )
        other = self.file_of_id.setdefault(identifier, file)
        if other is not file:
            message = f"case {quoted(identifier)} is also in {quoted(display_name(other.path))}"
            raise single_error(name, message, "name", "give every scenario a name of its own")
        if identifier in file.ids:
            raise duplicate_id(identifier, variant, file.ids[identifier])
        file.ids[identifier] = variant
        return identifier


def _without_search(merged: Map, vary: Entry | None) -> tuple[Map, Entry | None]:
    """Take off what a search looks for. Raises ScenarioErrors where the file is a sweep as well."""
    search = merged.entries.get("search")
    if search is None or is_null(search.node):
        return merged.without("search"), None
    if vary is not None:
        hint = (
            "a search varies what its own `ranges`, `profile` and `faults` say: move it to a file of its own"
        )
        raise single_error(search.key, "a sweep has no 'search' beside 'vary'", "search", hint)
    return merged.without("search"), search


def load_part(reference: str) -> Part:
    """The library part called ``folder/name``, e.g. ``vehicles/intercity-180``.

    Raises ScenarioErrors when there is none, KeyError when there is no such folder.
    """
    folder, _, name = reference.partition("/")
    models = {folder_of(each.model): each.model for each in PART_KEYS.values()}
    if folder not in models:
        raise KeyError(folder)
    location = Location(Document(reference, Path(), reference), 1, len(folder) + 2)
    part: Part = Parts(Files()).part(Scalar(name, name, location), models[folder], (folder,)).part
    return part


def load_part_file(path: Path, trusted: Sequence[Path] = ()) -> Part:
    """The part that a file describes, of any kind.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    files = Files(Roots.of([path], trusted))
    tree = files.at(path)
    schema = tree.get("schema")
    models = {f"uictest/{kind}/1": PART_KEYS[key].model for key, kind in PART_KINDS.items()}
    if not isinstance(schema, Scalar) or schema.text not in models:
        schema_text = quoted(schema.text) if isinstance(schema, Scalar) else "none"
        location = tree.location if schema is None else schema.location
        raise single_error(
            location, f"not a part: its schema is {schema_text}", "schema", f"accepted: {', '.join(models)}"
        )
    part: Part = _part_in(path, files, models[schema.text])
    return part


def _part_in(path: Path, files: Files, model: Any) -> Any:
    name = Scalar(path.name, path.name, Location(Document(str(path), path.parent, path.name)))
    return Parts(files).part(name, model, ()).part


def load_controller(
    reference: str, class_name: str = "", trusted: Sequence[Path] = (), library: Path | None = None
) -> ControllerPart:
    """The controller that ``reference`` names.

    Args:
        reference: a part file or a scenario file, the file of a program, the address of a socket, or the name
            of a controller of the library or of an installed package.
        class_name: class in a Python file; where it has one controller alone this may be left out.
        trusted: folders that may be read besides those of the files given and the working folder.
        library: takes the place of the one that a part file names, which need not be there.

    Raises:
        ScenarioErrors: when there is none, or a scenario has cases with several.
    """
    path, model = Path(reference), PART_KEYS["controller",].model
    files = Files(Roots.of([path], trusted))
    controller: ControllerPart
    if not (is_path(reference) and is_file(path)):
        controller = Parts(files).part(_node(reference, path, class_name), model, ()).part
        return controller
    if library is not None:
        places = {
            key: (Location(Document(COMMAND_LINE, file.parent, file.name)), file.name)
            for key, file in (("extends", path), ("library", library))
        }
        entries = {
            key: Entry(location, Scalar(name, name, location)) for key, (location, name) in places.items()
        }
        node = Map(entries, places["extends"][0])
        controller = Parts(Files(Roots.of([path, library], trusted))).part(node, model, ()).part
        return controller
    schema = files.at(path).get("schema")
    if not isinstance(schema, Scalar) or schema.value != SCENARIO_SCHEMA:
        controller = _part_in(path, files, model)
        return controller
    controller, *others = [case.scenario.controller for case in load([path], trusted=trusted)]
    if any(other != controller for other in others):
        hint = "name the file of one of them"
        raise single_error(whole_file(path), "its cases have different controllers", "controller", hint)
    return controller


def _node(reference: str, path: Path, class_name: str) -> Any:
    location = Location(Document(display_name(path), path.parent, reference))
    kind = "connect" if reference.startswith(SOCKET) else KIND_OF_ENDING.get(path.suffix.lower())
    if kind is None:
        return Scalar(reference, reference, location)
    text = reference if kind == "connect" else path.name
    entries = {kind: Entry(location, Scalar(text, text, location))}
    if kind == "python":
        name = class_name or _only_controller(path)
        entries["class"] = Entry(location, Scalar(name, name, location))
    return Map(entries, location)


def _only_controller(path: Path) -> str:
    """Return the class of a Python file that has a method `step`; the file is read, not run."""
    try:
        module = ast.parse(path.read_bytes(), path.name)
    except OSError as error:
        raise unreadable_error(whole_file(path), error) from None
    except (SyntaxError, ValueError) as error:
        raise single_error(whole_file(path), f"not Python: {error}") from None
    names = [
        each.name
        for each in module.body
        if isinstance(each, ast.ClassDef)
        and any(isinstance(inner, ast.FunctionDef) and inner.name == "step" for inner in each.body)
    ]
    if len(names) != 1:
        listed = ", ".join(map(quoted, names)) or "none"
        message = f"which class is the controller? Those with a method step: {listed}"
        raise single_error(whole_file(path), message, hint="name it with --class")
    return names[0]
