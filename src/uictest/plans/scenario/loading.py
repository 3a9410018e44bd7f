"""From files to cases."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from uictest.plans.scenario.case import Case, TrainPlace, with_another_controller
from uictest.plans.scenario.expansion import EXPANSION_KEYS, Variant, distinct, expand_valid
from uictest.plans.scenario.files import Files, Roots, scenario_trees
from uictest.plans.scenario.identifiers import (
    CAR,
    CONTROLLER,
    EXPECT,
    LONGEST,
    Labels,
    case_id,
    controller_labels,
    duplicate_id,
    sets_controller,
    short_keys,
)
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.overrides import OF_CAR, Override, apply_overrides, parse_overrides, with_value
from uictest.plans.scenario.rail_friction import changed_alone, overridden_alone
from uictest.plans.scenario.references import Parts
from uictest.plans.scenario.resolution import with_default_parts
from uictest.plans.scenario.resolved_cars import reaching_no_car, resolved_cars
from uictest.plans.scenario.train import (
    is_older,
    is_train,
    with_default_vehicles,
    without_inherited_vehicle,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    Diagnostic,
    Document,
    Entry,
    Map,
    Scalar,
    ScenarioErrors,
    as_written,
    collecting,
    display_name,
    in_reading_order,
    inherit,
    quoted,
    require_schema,
    single_error,
    whole_file,
)

_SECTIONS_OF_SWEEPS: Final = ("grid", "ranges", "sample")
"""Keys that a scenario has only under `vary`, and `grid`, which 0.2 had for `matrix`."""


class LoadedCase(NamedTuple):
    """A case and the tree that it is resolved from; `vary` is what a sweep of it varies.

    Of a car that a sweep varies, the tree is that of its train.
    """

    case: Case
    tree: Map
    vary: Entry | None = None


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
    if loader.diagnostics:
        raise ScenarioErrors(in_reading_order(loader.diagnostics))
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
    if loader.diagnostics:
        raise ScenarioErrors(in_reading_order(loader.diagnostics))
    return loaded


class _ScenarioFile(NamedTuple):
    """One scenario file: what its cases share, and the case of every id."""

    path: Path
    tree: Map
    documents: tuple[Document, ...]
    short: dict[str, str]
    labels: Labels
    vary: Entry | None
    ids: dict[str, Variant]
    inherits_expectation: bool
    """Whether it stands in a parent of the file that names the controller."""


def _conditions(variant: Variant) -> Variant:
    """Return what a case has of its own, but for what is expected of it: that is no condition of a stop."""
    return tuple(each for each in variant if OF_CAR.sub("", each.key) != EXPECT)


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
        expect, controller = merged.entries.get(EXPECT), merged.entries.get(CONTROLLER)
        inherits = expect is not None and controller is not None and is_older(expect, controller, documents)
        merged = without_inherited_vehicle(merged, documents)
        merged = with_default_vehicles(merged) if is_train(merged) else with_default_parts(merged)
        self.diagnostics.extend(overridden_alone(merged, self.overrides))
        merged = apply_overrides(merged, self.overrides)
        base = merged.without(*EXPANSION_KEYS)
        # Errors of the sweep do not hide those of its values: valid ones are checked nevertheless.
        variants = expand_valid(merged, self.diagnostics)
        if self.overrides:
            # Cases that differed only in a key that the command line sets are the same now.
            variants = distinct(variants)
        settings = [setting for variant in variants for setting in variant]
        short = short_keys(list(dict.fromkeys(setting.key for setting in settings)))
        labels = controller_labels(settings, self.parts)
        return _ScenarioFile(path, base, documents, short, labels, vary, {}, inherits), variants

    def _without_vary(self, own: Map, merged: Map) -> tuple[Map, Entry | None]:
        """Take off what a sweep varies. Raises ScenarioErrors where the file should be none, or is none."""
        vary = merged.entries.get("vary")
        if vary is not None and isinstance(vary.node, Scalar) and vary.node.value is None:
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
            raise single_error(own.place, "nothing varies", "vary", hint)
        return merged.without("vary", *EXPANSION_KEYS), vary

    def _parent(self, reference: Scalar) -> Map:
        files = self.parts.files
        tree = files.at(files.scenario_beside(reference, "extends"))
        require_schema(tree, SCENARIO_SCHEMA)
        return tree

    def _cases(self, file: _ScenarioFile, variant: Variant) -> list[LoadedCase]:
        """Return the case of a variant; of a train those of its cars, which name each other."""
        tree = self._varied(file.tree, variant)
        cars = resolved_cars(file.path, tree, self.parts)
        given = {each.key: Entry(each.place, each.values[0]) for each in self.overrides}
        given |= {setting.key: setting.value for setting in variant}
        self.diagnostics.extend(reaching_no_car(tree, given))
        expects = any(OF_CAR.sub("", key) == EXPECT for key in given)
        if (file.inherits_expectation or sets_controller(given)) and not expects:
            cars = [((with_another_controller(own), read), car) for (own, read), car in cars]
        scenarios = tuple(scenario for (scenario, _), _ in cars)
        named = scenarios[0].name, _conditions(variant), file.short, file.labels
        if not is_train(tree):
            return [self._case(file, variant, case_id(*named), *cars[0])]
        read = tuple(document for (_, documents), _ in cars for document in documents)
        return [
            self._case(
                *(file, variant, case_id(*named, car=number)),
                *((scenario, read), tree if self.varied else car),
                TrainPlace(case_id(*named), number, scenarios),
            )
            for number, ((scenario, _), car) in enumerate(cars, start=1)
        ]

    def _case(
        self,
        file: _ScenarioFile,
        variant: Variant,
        identifier: str,
        resolved: tuple[Scenario, tuple[Document, ...]],
        tree: Map,
        train: TrainPlace | None = None,
    ) -> LoadedCase:
        scenario, documents = resolved
        swept = {setting.key: as_written(setting.value.node) for setting in _conditions(variant)}
        case = Case(
            id=self._claimed(identifier, file, variant),
            scenario=scenario,
            path=Path(display_name(file.path)),
            parameters=swept if train is None else {**swept, CAR: str(train.number)},
            inputs={each.display: each.sha256 for each in (*file.documents, *documents) if each.sha256},
            train=train,
        )
        return LoadedCase(case, tree, file.vary)

    def _varied(self, base: Map, variant: Variant) -> Map:
        """The tree with the values of one case; settings that fail are reported and skipped."""
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
        name = file.tree.entries["name"].node.place
        place = variant[-1].value.node.place if variant else name
        if len(identifier) > LONGEST:
            raise single_error(
                place, f"the case id {quoted(identifier)} is longer than {LONGEST} characters", "name"
            )
        other = self.file_of_id.setdefault(identifier, file)
        if other is not file:
            message = f"case {quoted(identifier)} is also in {quoted(display_name(other.path))}"
            raise single_error(name, message, "name", "give every scenario a name of its own")
        if identifier in file.ids:
            raise duplicate_id(identifier, variant, file.ids[identifier])
        file.ids[identifier] = variant
        return identifier
