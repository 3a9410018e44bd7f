"""Controllers from outside in sweeps: lane by lane or one by one, with the bits of a stop alone."""

import pickle

import numpy as np
import pytest

from uictest import __version__, rig
from uictest.core.measures import STOP_COLUMNS
from uictest.plans.sweeps import each_controller, programs_of
from uictest.report import SweptController
from uictest.rig import run_in_process
from uictest.running.campaign import RecordingRequest, Stop, map_on_threads, run_stop
from uictest.running.chunked import chunk_runner, cluster, named_controller
from uictest.running.chunked.store import program_digest

from ..conftest import TRAIN, rows, written_out

FRICTIONS = "  rail.friction: [0.06, 0.08, 0.10]\n"


def rows_of(plan):
    return rows(chunk_runner(plan, rig.run_block).run(np.arange(plan.size)))


def without_names(row):
    return {name: row[name] for name in (*STOP_COLUMNS, "outcome", "reason", "narrowest_margin")}


def with_common_noise(found, of):
    return [without_names(row) for row in found if row["parameters.controller"].startswith(of)]


def test_one_block_runs_controllers_of_all_kinds_with_the_same_bits(load, library, python_file):
    kinds = f"[slip-band, {{library: {library}}}, threshold, {{python: {python_file}}}]"
    found = rows_of(load(f"matrix:\n  controller: {kinds}\n{FRICTIONS}"))
    built_in = with_common_noise(found, "slip-band")
    assert [row["outcome"] for row in built_in].count("error") == 0
    assert with_common_noise(found, "{library") == built_in
    assert with_common_noise(found, "{python") == built_in
    assert with_common_noise(found, "threshold") != built_in
    assert found[3]["id"] == "study[controller=libband,friction=0.06]"
    lanes = rows_of(load(f"matrix:\n{FRICTIONS}", "controller=slip-band"))
    references = [row["reference_distance_m"] for row in lanes]
    assert [row["reference_distance_m"] for row in built_in] == references
    assert references[0] > references[1] > references[2] > 0.0


PAIR = TRAIN.replace("vehicle: crh380a, count: 2, brake: {command: 50 %}", "brake: {command: 80 %}")


def test_trains_have_the_same_bits_with_controllers_of_all_kinds(load, library, python_file):
    kinds = f"[slip-band, {{library: {library}}}, {{python: {python_file}}}]"
    plan = load(f"matrix:\n  controller: {kinds}\n{FRICTIONS}", stop=PAIR)
    found = rows_of(plan)
    built_in = with_common_noise(found, "slip-band")
    assert len(built_in) == 2 * 3
    assert {row["outcome"] for row in built_in} == {"skipped"}
    assert with_common_noise(found, "{library") == built_in
    assert with_common_noise(found, "{python") == built_in


def test_rows_and_result_name_the_controller_of_each_case(load, library, python_file):
    given = f"{{library: {library}, version: '2.0'}}, {{python: {python_file}}}"
    threshold, others = ("threshold", f"uictest {__version__}"), [("libband", "2.0"), ("SlipBand", "")]
    alone = load(f"matrix:\n  rail.friction: [0.06, 0.08]\n  controller: [threshold, {given}]\n")
    drawn = f"{{controller: {{choice: [threshold, {given}]}}}}"
    chosen = load(f"sample: {{size: 1, seed: 2, parameters: {drawn}}}\n")
    train = load(f"matrix:\n  train.1.controller: [{given}]\n{FRICTIONS}", stop=PAIR)
    assert names_in(rows_of(alone)) == [threshold, *others] * 2
    assert names_in(rows_of(train)) == [each for own in others for each in (threshold, own) * 3]
    for plan in (alone, chosen, train):
        assert [*dict.fromkeys(map(named_controller, each_controller(plan)))] == [
            SweptController(*threshold),
            SweptController("libband", "2.0", "library"),
            SweptController("SlipBand", "", "python"),
        ]


def names_in(found):
    return [(row["controller"], row["controller_version"]) for row in found]


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_train_whose_controller_fails_is_rows_of_errors_beside_the_others(load, python_file, jobs):
    """In child processes, whatever their number; a mixed train, too."""
    controller = f"{{python: {python_file}, parameters: {{fails_at: -1}}}}"
    train = PAIR.replace("[{}, {", f"[{{controller: slip-band}}, {{controller: {controller}, ")
    plan = load(f"matrix:\n  train.1.controller.parameters.fails_at: [-1, 9]\n{FRICTIONS}", stop=train)
    with rig.Workers() as workers:
        runner = chunk_runner(plan, workers.run_block, workers.run_train)
        blocks = np.array_split(np.arange(plan.size), 2 * jobs)
        parts = map_on_threads(lambda block: rows(runner.run(block)), blocks, jobs=jobs)
        found = [row for part in parts for row in part]
    why = "step failed: ValueError: told to (slip_band.py, line 20) (cycle 9)"
    told = f"controller: car 2 (slip_band.py): {why}"
    assert [row["reason"] for row in found[6:]] == [told] * 6
    assert {row["outcome"] for row in found[:6]} == {"skipped"}
    expected = rows_of(load(f"matrix:\n  controller: [slip-band]\n{FRICTIONS}", stop=PAIR))
    assert [without_names(row) for row in found[:6]] == [without_names(row) for row in expected]


@pytest.mark.parametrize("kind", ["library", "python"])
def test_a_controller_that_fails_is_a_row_and_the_others_keep_their_bits(load, kind, library, python_file):
    written = {"library": library, "python": python_file}[kind]
    swept = "matrix:\n  controller.parameters.fails_at: [-1, 0, 150]\n" + FRICTIONS
    controller = f"controller={{{kind}: {written}, parameters: {{}}}}"
    plan = load(swept, controller)
    found = rows_of(plan)
    place = " (slip_band.py, line 20)" if kind == "python" else ""
    error = "ValueError: told to" if kind == "python" else "told to"
    for index, row in enumerate(found):
        at = int(row["parameters.controller.parameters.fails_at"])
        if at >= 0:
            assert row["reason"] == f"controller: step failed: {error}{place} (cycle {at})"
            assert (row["outcome"], row["braking_distance_m"]) == ("error", None)
        else:
            case = written_out(plan, index, controller)
            alone = run_stop(Stop(case), RecordingRequest("none"), run_in_process).case_run.result
            assert alone.measures is not None
            assert row["braking_distance_m"] == alone.measures["braking_distance_m"]
            assert row["outcome"] == alone.outcome != "error"


UPPER_SLIDE = "controller.parameters.upper_slide"


@pytest.mark.parametrize(
    ("text", "texts"),
    [
        pytest.param("matrix: {%s: [0.1, 0.3]}", ["0.1", "0.3"], id="matrix"),
        pytest.param("ranges: {%s: {first: 0.1, last: 0.3, count: 3}}", ["0.1", "0.2", "0.3"], id="ranges"),
        pytest.param("zip: {%s: [0.1, 0.3], seed: [1, 2]}", ["0.1", "0.3"], id="zip"),
        pytest.param("sample: {size: 2, parameters: {%s: {choice: [0.3]}}}", ["0.3", "0.3"], id="choice"),
    ],
)
def test_parameters_of_a_controller_are_swept(load, python_file, text, texts):
    found = rows_of(load(f"{text % UPPER_SLIDE}\n", f"controller={{python: {python_file}}}"))
    assert [row[f"parameters.{UPPER_SLIDE}"] for row in found] == texts
    assert [row[f"values.{UPPER_SLIDE}"] for row in found] == [float(each) for each in texts]


@pytest.mark.parametrize(
    "distribution",
    [
        "uniform: [0.1, 0.3]",
        "log-uniform: [0.1, 0.3]",
        "triangular: [0.1, 0.2, 0.3]",
        "normal: {mean: 0.2, deviation: 0.1, lower: 0.1, upper: 0.3}",
    ],
)
def test_parameters_of_a_controller_are_drawn_as_bare_numbers(load, python_file, distribution):
    text = f"sample: {{size: 4, parameters: {{{UPPER_SLIDE}: {{{distribution}}}}}}}\n"
    plan = load(text, f"controller={{python: {python_file}}}")
    values = plan.settings(np.arange(4))[UPPER_SLIDE]
    assert all(type(value.content) is float and 0.1 <= value.content <= 0.3 for value in values)
    assert len({value.text for value in values}) == 4
    assert {row["outcome"] for row in rows_of(plan)} <= {"pass", "fail", "invalid"}


def test_a_plan_is_the_same_on_another_machine(load, python_file):
    plan = load(f"matrix:\n  controller: [threshold, {{python: {python_file}}}]\n")
    sent = pickle.loads(pickle.dumps(plan))
    assert list(programs_of(sent)) == list(programs_of(plan)) != []
    indices = np.arange(plan.size)
    assert chunk_runner(sent, rig.run_block).run(indices) == chunk_runner(plan, rig.run_block).run(indices)


def test_a_worker_without_the_file_of_a_controller_says_so(load, python_file, tmp_path):
    plan = load("matrix: {rail.friction: [0.1]}\n", f"controller={{python: {python_file}}}")
    (tmp_path / "slip_band.py").write_text("another one\n")
    with pytest.raises(RuntimeError, match=r"the worker does not have .*slip_band\.py as it is here"):
        cluster._run_chunk("token", program_digest(), plan, np.arange(1))
