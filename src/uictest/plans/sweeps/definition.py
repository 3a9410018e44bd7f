"""Read a sweep file, a scenario that says under `vary` what varies, into a plan."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from math import prod
from pathlib import Path
from typing import Final, NamedTuple

from uictest.plans import library
from uictest.plans.scenario import (
    CAR,
    FIXED,
    LONGEST,
    PASS,
    Files,
    Override,
    Parts,
    Roots,
    Scenario,
    Vary,
    load_with_trees,
    parse_overrides,
    sets_controller,
    sets_friction,
    short_keys,
    with_another_controller,
)
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    Diagnostic,
    Entry,
    List,
    Map,
    describe,
    diagnose,
    display_name,
    plain,
    quoted,
    require_none,
    require_schema,
    single_error,
    validated,
    visible,
)
from uictest.plans.sweeps.base_case import (
    REPEAT_KEYS,
    SEEDS_IN_SWEEPS,
    TIME_STEP,
    BaseCase,
    reject_other_steps,
    require_regular_step,
    survey_in_lists,
    survey_on_command_line,
)
from uictest.plans.sweeps.column import ParameterValue
from uictest.plans.sweeps.group_reader import GroupReader
from uictest.plans.sweeps.plan import Group, ListedGroup, Plan

_EXAMPLE: Final = "vary: {matrix: {rail.friction: [0.08, 0.10]}}"


class SweepFile(NamedTuple):
    """A sweep file as read.

    Args:
        name: of the sweep.
        title: one line for people.
        base: the case that is varied.
        vary: what varies, validated.
        tree: the sections of `vary` as written.
        cases_sha256: digest of all that the file says of its cases.

    """

    name: str
    title: str
    base: BaseCase
    vary: Vary
    tree: Map
    cases_sha256: str


def read_sweep_file(path: Path, fixed: Sequence[Override], parts: Parts) -> SweepFile:
    """Return a sweep file; `fixed` are values of the command line for its scenario. Raises ScenarioErrors."""
    tree = parts.files.at(path)
    require_schema(tree, SCENARIO_SCHEMA)
    loaded, *_ = load_with_trees(path, fixed, parts, varied=True)
    assert loaded.vary is not None
    sections = loaded.vary.node
    if not isinstance(sections, Map):
        message = f"expected a mapping, found {describe(sections)}"
        raise single_error(sections.location, message, "vary", f"write `{_EXAMPLE}`")
    scenario = loaded.case.scenario
    repeat = loaded.tree.entries.get("repeat")
    if repeat is not None and scenario.repeat > 1:
        message = f"the scenario repeats its stop {scenario.repeat} times"
        hint = f"a sweep runs one stop per case: {SEEDS_IN_SWEEPS}; --set repeat=1 runs the first stop alone"
        raise single_error(repeat.node.location, message, "repeat", hint)
    _reject_ranges_in_lists(sections)
    # In the order of the file: it is that of the cases.
    content = json.dumps({**plain(tree), "vary": plain(sections)}, default=str)
    return SweepFile(
        name=scenario.name,
        title=scenario.title,
        base=BaseCase(loaded.case, loaded.tree, parts),
        vary=validated(Vary, plain(sections), sections, ("vary",)),
        tree=sections,
        cases_sha256=hashlib.sha256(content.encode()).hexdigest(),
    )


def _reject_ranges_in_lists(sections: Map) -> None:
    lists = sections.get("matrix")
    diagnostics = [
        diagnose(
            entry.node.location,
            f"expected a list of values, found {describe(entry.node)}",
            f"vary.matrix.{key}",
            "a range of numbers goes under `ranges`: {first, last, step} or {first, last, count}",
        )
        for key, entry in (lists.entries.items() if isinstance(lists, Map) else ())
        if isinstance(entry.node, Map)
    ]
    require_none(diagnostics)


MOST_CASES: Final = 100_000_000
_SETS_CARS: Final = re.compile(r"train(\.\d+(\.count)?)?")
_SECTIONS: Final = ("matrix", "ranges", "zip")
SAMPLE_NAME: Final = "sample"
"""Name of the number of a drawn point in case ids."""


def load_sweep(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> Plan:
    """Return the plan of a sweep file.

    Args:
        path: a ``*.sweep.yaml``: a scenario with `vary`, or the name of one that ships.
        overrides: ``key=value`` texts. One value fixes a key of the scenario, swept or not; a comma list or
            ``range(first,last,step)`` replaces the values in the file.
        seed: of the sensors' noise in every case.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenario that it names.
    """
    path = library.named_scenario(path)
    given = parse_overrides(overrides, seed)
    survey = survey_on_command_line(given)
    parsed = given if survey is None else tuple(each for each in given if each.key != TIME_STEP)
    parts = Parts(Files(Roots.of([path], trusted)))
    file = read_sweep_file(path, [each for each in parsed if len(each.values) == 1], parts)
    sections = _without_keys(file.tree, {each.key for each in given})
    if survey is None:
        survey = survey_in_lists(sections.get("matrix"))
        sections = sections if survey is None else _without_entries(sections, "matrix", {TIME_STEP})
    if survey is not None:
        require_regular_step(file.base, survey)
        if file.base.case.train is not None:
            raise single_error(survey, "what the survey step does to trains is not known", TIME_STEP)
    reader = GroupReader(file.base, file.vary.ranges or {})
    groups = _groups_of_sections(file, sections, [each for each in parsed if len(each.values) > 1], reader)
    keys = [key for group in groups for key in group.keys]
    if survey is not None:
        reject_other_steps(keys, survey)
    documents = (parts.files.at(path).location.document, *reader.documents)
    read = {document.display: document.sha256 for document in documents if document.sha256}
    base = file.base.case.changed(with_another_controller) if sets_controller(keys) else file.base.case
    return Plan(
        name=file.name,
        title=file.title,
        file=display_name(path),
        base=base.changed(_without_allowance),
        groups=groups,
        short=short_keys(keys),
        inputs=dict(sorted({**file.base.case.inputs, **read}.items())),
        survey=survey is not None,
        cases_sha256=file.cases_sha256,
        own_keys=file.base.own_keys(keys),
    )


def _without_allowance(scenario: Scenario) -> Scenario:
    """Return a scenario that allows another controller nothing: a sweep lists no case with what it misses."""
    return scenario.model_copy(update={"expect": PASS}) if scenario.expect.is_allowance else scenario


_Axis = tuple[str, Mapping[str, Entry]]
"""A section, and the lists in it that change together, or the range of one key, as written."""


def _groups_of_sections(
    file: SweepFile, sections: Map, swept: Sequence[Override], reader: GroupReader
) -> tuple[Group, ...]:
    """Return the groups in order: those of the command line, lists, ranges, zip, sample.

    `sections` are what the command line leaves of the file. Raises ScenarioErrors.
    """
    axes = [*_axes_of_sections(sections, swept)]
    sample, requested = sections.get("sample"), file.vary.sample
    drawn = dict(_entries_of_section(sample, "parameters")) if isinstance(sample, Map) else {}
    diagnostics = [*_bad_keys(file, sections, [*axes, ("vary.sample", drawn)])]
    require_none(diagnostics)
    if requested is not None:
        parameters = {key: each for key, each in requested.parameters.items() if key in drawn}
        requested = requested.model_copy(update={"parameters": parameters}) if drawn else None
    train = file.base.case.train
    counts = {", ".join(entries): reader.count(entries, section) for section, entries in axes}
    cars = 1 if train is None else len(train.scenarios)
    _require_few(counts | {SAMPLE_NAME: requested.cases if requested else 1, "train": cars}, sections)
    groups: list[Group | None] = [reader.listed(entries, section) for section, entries in axes]
    if requested is not None and isinstance(sample, Map):
        groups.append(reader.sampled(requested, sample))
    require_none(reader.diagnostics)
    if train is not None and requested is not None and requested.method == "saltelli":
        message = "sensitivities are of a car alone"
        raise single_error(sections.entries["sample"].key, message, "vary.sample", "take method: sobol")
    if train is not None:  # the cars of a case are neighbours, so that their train runs once
        numbers = [str(number + 1) for number in range(len(train.scenarios))]
        groups.append(ListedGroup((CAR,), tuple((ParameterValue(*3 * (each,)),) for each in numbers)))
    complete = tuple(group for group in groups if group is not None)
    longest_id = sum(map(_longest_label, complete)) + len(file.name) + 2
    if longest_id > LONGEST:
        message = f"case ids of up to {longest_id} characters; {LONGEST} are accepted"
        raise single_error(sections.location, message)
    return complete


def _axes_of_sections(sections: Map, swept: Sequence[Override]) -> Iterator[_Axis]:
    for each in swept:
        yield "--set", {each.key: Entry(each.location, List(each.values, each.location))}
    for section in ("matrix", "ranges"):
        for key, entry in _entries_of_section(sections, section):
            yield f"vary.{section}", {key: entry}
    if zipped := dict(_entries_of_section(sections, "zip")):
        yield "vary.zip", zipped


def _require_few(counts: Mapping[str, int], sections: Map) -> None:
    if (size := prod(counts.values())) > MOST_CASES:
        factors = " x ".join(f"{count} of {visible(key)}" for key, count in counts.items() if count > 1)
        message = f"{size} cases ({factors}); at most {MOST_CASES} are accepted"
        hint = "list fewer values, or draw them all under `sample` in place of every combination"
        raise single_error(sections.location, message, "vary", hint)


def _bad_keys(file: SweepFile, sections: Map, axes: Sequence[_Axis]) -> Iterator[Diagnostic]:
    """Yield keys that stand in two sections or cannot vary, and rail conditions that change alone."""
    section_of: dict[str, str] = {}
    for section, entries in axes:
        for key, entry in entries.items():
            shown = f"{section}.{key}"
            if key in section_of:
                yield diagnose(entry.key, f"{quoted(key)} is under {section_of[key]} as well", shown)
            if key.split(".")[0] in FIXED:
                message = f"{quoted(key)} belongs to the scenario's file and cannot vary"
                yield diagnose(entry.key, message, shown)
            if key.split(".")[0] in REPEAT_KEYS:
                message = f"{quoted(key)} cannot vary: a sweep runs one stop per case"
                yield diagnose(entry.key, message, shown, SEEDS_IN_SWEEPS)
            if _SETS_CARS.fullmatch(key):
                hint = "vary what a car has: `train.0.vehicle`"
                yield diagnose(entry.key, "the cars of a train and their number cannot vary", shown, hint)
            section_of[key] = section
    if not any(map(sets_friction, section_of)):
        for _, entries in axes:
            yield from file.base.conditions_alone(entries)
    if not section_of:
        names = "vary.matrix, vary.ranges, vary.zip, vary.sample"
        yield diagnose(sections.location, "nothing varies", hint=f"give values under {names}")


def _longest_label(group: Group) -> int:
    if not isinstance(group, ListedGroup):
        return len(SAMPLE_NAME) + 1 + len(str(group.size))
    # A short key is at most the key itself; the comma after each counts too.
    return sum(
        len(key) + 2 + max(len(value.label) for value in values)
        for key, values in zip(group.keys, group.choices, strict=True)
    )


def _without_keys(tree: Map, keys: set[str]) -> Map:
    for section in _SECTIONS:
        tree = _without_entries(tree, section, keys)
    sample = tree.entries.get("sample")
    if sample is not None and isinstance(sample.node, Map):
        tree = tree.with_entry("sample", Entry(sample.key, _without_entries(sample.node, "parameters", keys)))
    return tree


def _without_entries(tree: Map, section: str, keys: set[str]) -> Map:
    entry = tree.entries.get(section)
    if entry is None or not isinstance(entry.node, Map) or not keys & set(entry.node.entries):
        return tree
    return tree.with_entry(section, Entry(entry.key, entry.node.without(*keys)))


def _entries_of_section(tree: Map, section: str) -> Iterator[tuple[str, Entry]]:
    node = tree.get(section)
    if isinstance(node, Map):
        yield from node.entries.items()
