"""A chunk holds the results of its cases run one by one, and every case has a row."""

import math
from dataclasses import replace

import numpy as np
import pytest

from uictest.analysis.summaries import summarized
from uictest.judging.evaluation import evaluate
from uictest.running import chunked
from uictest.running.chunked import CaseSelection, ChunkStore, run_on_threads
from uictest.running.chunked.chunk import queues_of
from uictest.runs import Observer, SweepRequest
from uictest.runs.sweep_chunks import run_missing_chunks

from ..conftest import formula, result_of, rows
from .test_case_blocks import written_out


def test_rows_are_the_results_of_the_cases(load, made_up):
    plan = load()
    runner = made_up(plan)
    found = rows(runner.run(np.arange(plan.size)))
    for index, row in enumerate(found):
        block = runner.assembler.block(np.array([index]))
        measures, wheelsets = formula(block.parameters, block.wheelset_parameters, block.rail)
        result = evaluate(written_out(plan, index), measures[0], wheelsets[0])
        assert (row["index"], row["id"]) == (index, result.id)
        assert (row["outcome"], row["met"], row["reason"]) == (result.outcome, result.met, result.reason)
        assert row["braking_distance_m"] == result.measures["braking_distance_m"]
    assert [row["parameters.brake.command"] for row in found] == ["80 %", "100 %"] * 3
    assert {row["outcome"] for row in found} == {"pass", "fail"}


def test_the_same_cases_give_the_same_bytes_and_a_measure_without_a_value_is_null(load, made_up):
    row = rows(made_up(load()).run(np.array([0])))[0]
    assert row["initial_adhesion_g"] is None
    assert row["values.rail.friction"] == 0.08
    plan = load()
    assert made_up(plan).run(np.arange(6)) == made_up(plan).run(np.arange(6))


def test_chunks_that_share_a_queue_give_the_bytes_of_each_alone(load, made_up):
    plan = load("sample: {size: 90, parameters: {brake.command: {uniform: [60 %, 100 %]}}}\n")
    runner = made_up(plan)
    chunks = [np.arange(0, 31), np.arange(31, 62), np.arange(62, 90)]
    assert runner.run_together(chunks) == [runner.run(each) for each in chunks]


@pytest.mark.parametrize(
    ("chunks", "jobs", "sizes"),
    [
        (33, 2, [8, 7, 5, 4, 3, 2, 2, 1, 1]),
        (19, 2, [5, 4, 3, 2, 2, 2, 1]),
        (3, 2, [2, 1]),
        (33, 1, [8, 8, 8, 8, 1]),
        (9, 4, [2, 2, 2, 1, 1, 1]),
    ],
)
def test_queues_hold_every_chunk_once_and_become_shorter_for_threads_to_end_together(chunks, jobs, sizes):
    queues = queues_of(range(chunks), jobs, 31)
    assert [chunk for queue in queues for chunk in queue] == list(range(chunks))
    assert [len(queue) for queue in queues] == sizes


def test_queues_of_long_chunks_are_chunks():
    assert queues_of(range(70), 2, 1024) == [range(n, n + 1) for n in range(70)]


@pytest.mark.parametrize(
    ("jobs", "queues"), [(1, [8, 8, 8, 8]), (2, [8, 6, 5, 4, 3, 2, 2, 1, 1]), (100, [1] * 32)]
)
def test_threads_take_queues_of_chunks_that_come_out_in_order(load, made_up, jobs, queues):
    plan = load("sample: {size: 1000, parameters: {brake.command: {uniform: [60 %, 100 %]}}}\n")
    selection, runner = CaseSelection(plan), made_up(plan)
    sizes = []

    def simulate(parameters, own, rail):
        sizes.append(len(parameters))
        return formula(parameters, own, rail)

    written = []
    run_on_threads(
        replace(runner, simulate=simulate),
        selection,
        range(32),
        jobs,
        lambda number, _: written.append(number),
    )
    assert written == list(range(32))
    assert sorted(sizes) == sorted(31 * chunks for chunks in queues)


def test_chunks_are_summarised_in_their_order_whatever_the_order_in_which_they_are_finished(
    load, made_up, tmp_path, monkeypatch
):
    plan = load("sample: {size: 80, parameters: {brake.command: {uniform: [60 %, 100 %]}}}\n")
    selection, runner = CaseSelection(plan), made_up(plan)
    store, ends, calls = ChunkStore(tmp_path), [], []

    def run_in_disorder(_, selection, numbers, jobs, write_chunk, meanwhile):
        meanwhile()
        for number in sorted(numbers, key=[4, 0, 1, 3].index):
            write_chunk(number, runner.run(selection.chunk(number)))

    store.open({"sweep": plan.name}, restart=False)
    store.write(2, runner.run(selection.chunk(2)))
    monkeypatch.setattr(chunked, "run_on_threads", run_in_disorder)
    request = SweepRequest(selection, {"sweep": plan.name}, tmp_path, jobs=1)
    run_missing_chunks(request, store, Observer(), ends.append, lambda: calls.append(len(ends)))
    assert (ends, calls) == ([0, 1, 3, 5], [0])
    whole = result_of(selection, store)
    with summarized(selection, store, None, ["braking_distance_m"]) as summary:
        for end in ends:
            summary.add_up_to(end)
        assert summary.result().result == whole


def test_a_case_that_fails_is_a_row_with_its_reason(load, made_up):
    def breaks(parameters, own, rail):
        if (rail[:, 1, 0] == 0.10).any():
            raise ZeroDivisionError("no wheel load")
        return formula(parameters, own, rail)

    plan = load()
    found = rows(replace(made_up(plan), simulate=breaks).run(np.arange(plan.size)))
    assert [row["outcome"] == "error" for row in found] == [
        row["values.rail.friction"] == 0.10 for row in found
    ]
    assert found[2]["reason"] == "ZeroDivisionError: no wheel load"
    assert found[2]["braking_distance_m"] is None


def test_a_rejected_combination_is_a_row_with_its_reason(load, made_up):
    plan = load("matrix: {simulation.time_step: [0.5 ms, 0.4 ms], controller.cycle_time: [10 ms, 5 ms]}\n")
    found = rows(made_up(plan).run(np.arange(4)))
    assert [row["outcome"] for row in found].count("error") == 1
    assert "does not divide the controller cycle" in found[3]["reason"]
    assert not math.isnan(found[0]["braking_distance_m"])
