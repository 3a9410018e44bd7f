"""Read a sweep file into a plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Final

from uictest.plans.scenario import CONDITION, LONGEST, Files, Parts, Roots, Sample, sets_friction, short_keys
from uictest.plans.scenario.yaml import (
    FIXED,
    Diagnostic,
    Document,
    Entry,
    Map,
    Override,
    ScenarioErrors,
    Sequence as List,
    diagnose,
    display_name,
    in_reading_order,
    parse_overrides,
    quoted,
    single_error,
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
from uictest.plans.sweeps.group_reader import GroupReader, range_node
from uictest.plans.sweeps.plan import (
    Group,
    ListedGroup,
    Plan,
    SampledGroup,
    random_sample,
    scenarios_with_each,
)
from uictest.plans.sweeps.sweep_file import SweepFile, read_sweep_file

DRY: Final = "dry"
"""Name of the rail condition that K_dry is defined for."""
_RANDOM: Final = "a quantile is bounded from independent draws: write `sample: {method: random, ...}`"


def reject_unsupported_tails(plan: Plan, file: SweepFile) -> None:
    """Raise ScenarioErrors where quantiles or K_dry lack a random sample, or K_dry a dry rail.

    The errors are reported at the keys of the file.
    """
    diagnostics = [
        diagnose(file.tree.entries[section].key, message, file.key(section), hint)
        for section, is_requested in (("quantiles", plan.quantiles), ("k_dry", plan.k_dry is not None))
        if is_requested
        for message, hint in _problems(plan, of_dry_rail=section == "k_dry")
    ]
    if diagnostics:
        raise ScenarioErrors(diagnostics)


def _problems(plan: Plan, *, of_dry_rail: bool) -> Iterator[tuple[str, str]]:
    """Yield what is wrong and what to write instead."""
    last = plan.groups[-1]
    if not isinstance(last, SampledGroup):
        yield "the values of this sweep are listed, not drawn", _RANDOM
    elif random_sample(plan) is None:
        yield f"points of method {last.method} are not independent of each other", _RANDOM
    if of_dry_rail:
        for name in dict.fromkeys(_conditions(plan)):
            if name != DRY:
                hint = "write `rail: {condition: dry}` in the scenario, and no other condition in the sweep"
                yield f"K_dry holds for dry rail; the rail condition is {quoted(name)}", hint


def _conditions(plan: Plan) -> Iterator[str]:
    """Yield the names of the rail conditions that the cases have."""
    yield from (scenario.rail.condition.name for scenario in scenarios_with_each(plan, CONDITION))


MOST_CASES: Final = 100_000_000
_SECTIONS: Final = ("matrix", "ranges", "zip")
SAMPLE_NAME: Final = "sample"
"""Name of the number of a drawn point in case ids."""


def load_sweep(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> Plan:
    """Return the plan of a sweep file.

    Args:
        path: a ``*.sweep.yaml``: a scenario with `vary`, or a sweep as 0.2 wrote it.
        overrides: ``key=value`` texts. One value fixes a key of the scenario, swept or not; a comma list or
            ``range(first,last,step)`` replaces the values in the file.
        seed: of the sensors' noise in every case.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenario that it names.
    """
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
    reader = _Reader(file, sections)
    groups = reader.groups([each for each in parsed if len(each.values) > 1])
    if survey is not None:
        reject_other_steps((key for group in groups for key in group.keys), survey)
    document = parts.files.at(path).place.document
    plan = Plan(
        name=file.name,
        title=file.title,
        file=display_name(path),
        base=file.base.case,
        groups=groups,
        short=short_keys([key for group in groups for key in group.keys]),
        inputs=_inputs(file.base, (document, *reader.group_reader.documents)),
        quantiles=file.vary.quantile_requests,
        k_dry=file.vary.k_dry,
        survey=survey is not None,
        cases_sha256=file.cases_sha256,
        written_now=file.written_now,
    )
    reject_unsupported_tails(plan, file)
    return plan


@dataclass(frozen=True)
class _Axis:
    """Lists that change together, and the section that holds them."""

    section: str
    entries: Mapping[str, Entry]


class _Reader:
    """Reads the groups of a file, and collects all errors; `sections` are what the command line leaves."""

    def __init__(self, file: SweepFile, sections: Map) -> None:
        self.group_reader = GroupReader(file.base)
        self._file = file
        self._tree = sections

    def groups(self, swept: Sequence[Override]) -> tuple[Group, ...]:
        """Return the groups in order: those of the command line, lists, ranges, zip, sample."""
        axes = [*_of_command_line(swept), *self._of_file()]
        self._reject_bad_keys(axes)
        groups: list[Group | None] = [self.group_reader.listed(axis.entries, axis.section) for axis in axes]
        sample = self._tree.get("sample")
        if isinstance(sample, Map) and self._file.vary.sample is not None:
            remaining = self._sample_without_overridden(sample)
            if remaining.parameters:
                groups.append(self.group_reader.sampled(remaining, sample))
        self._raise_diagnostics()
        complete = tuple(group for group in groups if group is not None)
        self._reject_size(complete)
        return complete

    def _of_file(self) -> Iterator[_Axis]:
        for key, entry in _entries(self._tree, "matrix"):
            yield _Axis(self._file.key("matrix"), {key: entry})
        for key, entry in _entries(self._tree, "ranges"):
            values = (self._file.vary.ranges or {})[key]
            yield _Axis(self._file.key("ranges"), {key: Entry(entry.key, range_node(values, entry.node))})
        zipped = dict(_entries(self._tree, "zip"))
        if zipped:
            yield _Axis(self._file.key("zip"), zipped)

    def _sample_without_overridden(self, sample: Map) -> Sample:
        requested = self._file.vary.sample
        assert requested is not None
        drawn = dict(_entries(sample, "parameters"))
        parameters = {key: each for key, each in requested.parameters.items() if key in drawn}
        return requested.model_copy(update={"parameters": parameters})

    def _reject_bad_keys(self, axes: Sequence[_Axis]) -> None:
        sample = self._tree.get("sample")
        drawn = dict(_entries(sample, "parameters")) if isinstance(sample, Map) else {}
        all_axes = (*axes, _Axis(self._file.key("sample"), drawn))
        self.group_reader.diagnostics.extend(_bad_keys(all_axes))
        keys = [key for axis in all_axes for key in axis.entries]
        if not any(map(sets_friction, keys)):
            for axis in all_axes:
                self.group_reader.reject_conditions_alone(axis.entries)
        if not keys:
            sections = ("matrix", "ranges", "zip", "sample")
            hint = "give values under " + ", ".join(map(self._file.key, sections))
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


def _inputs(base: BaseCase, documents: Sequence[Document]) -> dict[str, str]:
    read = {document.display: document.sha256 for document in documents if document.sha256}
    return dict(sorted(chain(base.case.inputs.items(), read.items())))
