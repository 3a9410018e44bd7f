"""Read a sweep file into a plan."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Final

from uictest.plans.scenario import LONGEST, Roots, sets_friction, short_keys
from uictest.plans.scenario.yaml import (
    FIXED,
    Diagnostic,
    Document,
    Entry,
    Map,
    Node,
    Override,
    Scalar,
    ScenarioErrors,
    Sequence as List,
    describe,
    diagnose,
    display_name,
    in_reading_order,
    parse_overrides,
    plain,
    quoted,
    read_file,
    single_error,
    validated,
)
from uictest.plans.sweeps.base_case import (
    REPEAT_KEYS,
    SEEDS_IN_SWEEPS,
    TIME_STEP,
    BaseCase,
    read_base_case,
    reject_other_steps,
    requested_survey,
    require_regular_step,
)
from uictest.plans.sweeps.group_reader import GroupReader, range_node
from uictest.plans.sweeps.model import MOST_CASES, SWEEP_SCHEMA, Sample, SweepFile
from uictest.plans.sweeps.plan import Group, ListedGroup, Plan
from uictest.plans.sweeps.tail_requests import reject_unsupported_tails

_SCHEMA_HINT: Final = f"a sweep starts with `schema: {SWEEP_SCHEMA}`"
_SECTIONS: Final = ("grid", "ranges", "zip")
_OF_SUMMARY: Final = ("quantiles", "k_dry")
"""Keys that say what to compute from finished cases."""
SAMPLE_NAME: Final = "sample"
"""Name of the number of a drawn point in case ids."""


def load_sweep(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> Plan:
    """Return the plan of a sweep file.

    Args:
        path: a ``*.sweep.yaml``.
        overrides: ``key=value`` texts. One value fixes a key of the scenario, swept or not; a comma list or
            ``range(first,last,step)`` replaces the values in the file.
        seed: of the sensors' noise in every case.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenario that it names.
    """
    parsed = parse_overrides(overrides, seed)
    tree = read_file(path, _SCHEMA_HINT)
    _reject_other_schema(tree)
    _reject_ranges_in_grid(tree)
    file: SweepFile = validated(SweepFile, plain(tree), tree)
    survey = requested_survey(tree, parsed)
    written, tree = tree, _without_keys(tree, {each.key for each in parsed})
    if survey is not None:
        parsed = tuple(each for each in parsed if each.key != TIME_STEP)
        tree = _without_entries(tree, "grid", {TIME_STEP})
    fixed = [each for each in parsed if len(each.values) == 1]
    roots = Roots.of([path], trusted)
    base = read_base_case(_scalar(tree, "scenario"), _optional(tree, "case"), fixed, roots)
    if survey is not None:
        require_regular_step(base, survey)
    reader = _Reader(base, tree, file)
    groups = reader.groups([each for each in parsed if len(each.values) > 1])
    if survey is not None:
        reject_other_steps((key for group in groups for key in group.keys), survey)
    plan = Plan(
        name=file.name,
        title=file.title,
        file=display_name(path),
        base=base.case,
        groups=groups,
        short=short_keys([key for group in groups for key in group.keys]),
        inputs=_inputs(base, (tree.place.document, *reader.group_reader.documents)),
        quantiles=file.quantile_requests,
        k_dry=file.k_dry,
        survey=survey is not None,
        cases_sha256=_sha256_of_cases(written),
    )
    reject_unsupported_tails(plan, tree)
    return plan


def _sha256_of_cases(tree: Map) -> str:
    content = {key: value for key, value in plain(tree).items() if key not in _OF_SUMMARY}
    # In the order of the file: it is that of the cases.
    return hashlib.sha256(json.dumps(content, default=str).encode()).hexdigest()


@dataclass(frozen=True)
class _Axis:
    """Lists that change together, and the section that holds them."""

    section: str
    entries: Mapping[str, Entry]


class _Reader:
    """Reads the groups of a file, and collects all errors."""

    def __init__(self, base: BaseCase, tree: Map, file: SweepFile) -> None:
        self.group_reader = GroupReader(base)
        self._tree = tree
        self._file = file

    def groups(self, swept: Sequence[Override]) -> tuple[Group, ...]:
        """Return the groups in order: those of the command line, grid, ranges, zip, sample."""
        axes = [*_of_command_line(swept), *self._of_file()]
        self._reject_bad_keys(axes)
        groups: list[Group | None] = [self.group_reader.listed(axis.entries) for axis in axes]
        sample = self._tree.get("sample")
        if isinstance(sample, Map) and self._file.sample is not None:
            remaining = self._sample_without_overridden(sample)
            if remaining.parameters:
                groups.append(self.group_reader.sampled(remaining, sample))
        self._raise_diagnostics()
        complete = tuple(group for group in groups if group is not None)
        self._reject_size(complete)
        return complete

    def _of_file(self) -> Iterator[_Axis]:
        for key, entry in _entries(self._tree, "grid"):
            yield _Axis("grid", {key: entry})
        for key, entry in _entries(self._tree, "ranges"):
            values = (self._file.ranges or {})[key]
            yield _Axis("ranges", {key: Entry(entry.key, range_node(values, entry.node))})
        zipped = dict(_entries(self._tree, "zip"))
        if zipped:
            yield _Axis("zip", zipped)

    def _sample_without_overridden(self, sample: Map) -> Sample:
        assert self._file.sample is not None
        drawn = dict(_entries(sample, "parameters"))
        parameters = {key: each for key, each in self._file.sample.parameters.items() if key in drawn}
        return self._file.sample.model_copy(update={"parameters": parameters})

    def _reject_bad_keys(self, axes: Sequence[_Axis]) -> None:
        sample = self._tree.get("sample")
        drawn = dict(_entries(sample, "parameters")) if isinstance(sample, Map) else {}
        all_axes = (*axes, _Axis("sample", drawn))
        self.group_reader.diagnostics.extend(_bad_keys(all_axes))
        keys = [key for axis in all_axes for key in axis.entries]
        if not any(map(sets_friction, keys)):
            for axis in all_axes:
                self.group_reader.reject_conditions_alone(axis.entries)
        if not keys:
            hint = "give values under grid, ranges, zip or sample"
            self.group_reader.diagnostics.append(diagnose(self._tree.place, "nothing varies", hint=hint))
        self._raise_diagnostics()

    def _reject_size(self, groups: Sequence[Group]) -> None:
        plan_size = 1
        for group in groups:
            plan_size *= group.size
        longest_id = sum(_longest_label(group) for group in groups) + len(self._file.name) + 2
        if plan_size > MOST_CASES:
            hint = "draw a sample instead of every combination"
            raise single_error(
                self._tree.place, f"{plan_size} cases; at most {MOST_CASES} are accepted", hint=hint
            )
        if longest_id > LONGEST:
            raise single_error(
                self._tree.place, f"case ids of up to {longest_id} characters; {LONGEST} are accepted"
            )

    def _raise_diagnostics(self) -> None:
        if self.group_reader.diagnostics:
            raise ScenarioErrors(in_reading_order(self.group_reader.diagnostics))


def _bad_keys(axes: Sequence[_Axis]) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each key that stands in two sections or cannot vary."""
    section_of: dict[str, str] = {}
    for axis in axes:
        for key, entry in axis.entries.items():
            if key in section_of:
                message = f"{quoted(key)} is under {section_of[key]} as well"
                yield diagnose(entry.key, message, f"{axis.section}.{key}")
            if key.split(".")[0] in FIXED:
                message = f"{quoted(key)} belongs to the scenario's file and cannot vary"
                yield diagnose(entry.key, message, f"{axis.section}.{key}")
            if key.split(".")[0] in REPEAT_KEYS:
                message = f"{quoted(key)} cannot vary: a sweep runs one stop per case"
                yield diagnose(entry.key, message, f"{axis.section}.{key}", SEEDS_IN_SWEEPS)
            section_of[key] = axis.section


def _of_command_line(swept: Sequence[Override]) -> Iterator[_Axis]:
    for each in swept:
        yield _Axis("--set", {each.key: Entry(each.place, List(each.values, each.place))})


def _longest_label(group: Group) -> int:
    if not isinstance(group, ListedGroup):
        return len(SAMPLE_NAME) + 1 + len(str(group.size))
    # A short key is at most the key itself; the comma after each counts too.
    return sum(
        len(key) + 2 + max(len(row[place].label) for row in group.rows)
        for place, key in enumerate(group.keys)
    )


def _reject_other_schema(tree: Map) -> None:
    schema = tree.get("schema")
    if schema is None:
        raise single_error(tree.place, "missing key 'schema'", "schema", _SCHEMA_HINT)
    if not isinstance(schema, Scalar) or schema.value != SWEEP_SCHEMA:
        actual = quoted(schema.text) if isinstance(schema, Scalar) else describe(schema)
        scenario = isinstance(schema, Scalar) and schema.text.startswith("uictest/scenario/")
        hint = "a scenario is run with `uictest run`" if scenario else _SCHEMA_HINT
        raise single_error(schema.place, f"expected {SWEEP_SCHEMA}, found {actual}", "schema", hint)


def _reject_ranges_in_grid(tree: Map) -> None:
    """Reject a range in the section of lists, and name the section of ranges."""
    diagnostics = [
        diagnose(
            entry.node.place,
            f"expected a list of values, found {describe(entry.node)}",
            f"grid.{key}",
            "a range of numbers goes under `ranges`: {first, last, step} or {first, last, count}",
        )
        for key, entry in _entries(tree, "grid")
        if isinstance(entry.node, Map)
    ]
    if diagnostics:
        raise ScenarioErrors(diagnostics)


def _without_keys(tree: Map, keys: set[str]) -> Map:
    """Return the file without the swept keys that the command line sets."""
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


def _entries(tree: Map, section: str) -> Iterator[tuple[str, Entry]]:
    node = tree.get(section)
    if isinstance(node, Map):
        yield from node.entries.items()


def _scalar(tree: Map, key: str) -> Scalar:
    node: Node = tree.entries[key].node
    assert isinstance(node, Scalar)
    return node


def _optional(tree: Map, key: str) -> Scalar | None:
    node = tree.get(key)
    return node if isinstance(node, Scalar) and node.value is not None else None


def _inputs(base: BaseCase, documents: Sequence[Document]) -> dict[str, str]:
    read = {document.display: document.sha256 for document in documents if document.sha256}
    return dict(sorted(chain(base.case.inputs.items(), read.items())))
