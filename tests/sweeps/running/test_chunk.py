"""Chunks: which cases they hold, and the results of their cases run one by one."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries import summarized
from uictest.judging.evaluation import evaluate
from uictest.running import chunked
from uictest.running.campaign import ExpressionError
from uictest.running.chunked import (
    CaseSelection,
    ChunkStore,
    Shard,
    parse_shard,
    run_on_threads,
    select_cases,
)
from uictest.running.chunked.chunk import queues_of
from uictest.runs import Observer, SweepRequest
from uictest.runs.sweep import run_missing_chunks

from ..conftest import formula, formula_of, made_up, result_of, rows, written_out


def test_an_expression_selects_by_id_and_chunks_are_those_of_a_selection(load):
    plan = load()
    selection = select_cases(plan, "friction=0.10 and not command=80")
    assert plan.ids(selection.indices(0, selection.size)) == ["study[friction=0.10,command=100]"]
    assert select_cases(plan, "study.sweep").size == 6
    assert select_cases(plan, "nothing").size == 0
    with pytest.raises(ExpressionError):
        select_cases(plan, "and")
    selection = CaseSelection(load(), np.array([5, 1, 3]))
    assert (selection.size, selection.chunks) == (3, 1)
    assert selection.chunk(0).tolist() == [5, 1, 3]


@given(st.integers(1, 3_000_000))
def test_chunks_are_all_cases_once_and_of_a_bounded_size(size):
    selection = CaseSelection(SimpleNamespace(size=size))
    edges = [selection.chunk(0)[0], selection.chunk(selection.chunks - 1)[-1]]
    assert edges == [0, size - 1]
    assert selection.chunk(0).size <= selection.chunk_size <= 4096
    assert (
        sum(selection.chunk(number).size for number in (0, selection.chunks - 1)[: selection.chunks]) <= size
    )


@pytest.mark.parametrize(
    ("size", "chunk"), [(10, 16), (448, 16), (3000, 93), (50_000, 1024), (10**5, 1562), (10**6, 4096)]
)
def test_a_chunk_is_a_fraction_of_the_cases_between_bounds(size, chunk):
    assert CaseSelection(SimpleNamespace(size=size)).chunk_size == chunk


@given(st.integers(0, 50), st.integers(1, 12))
def test_shards_are_all_chunks_once(chunks, count):
    shards = [Shard(number, count).chunk_numbers(chunks) for number in range(1, count + 1)]
    assert sorted(number for shard in shards for number in shard) == list(range(chunks))
    assert max(map(len, shards)) - min(map(len, shards)) <= 1


@pytest.mark.parametrize("text", ["0/3", "4/3", "1", "1/0", "a/b", "1/2/3", "-1/2"])
def test_a_shard_is_written_as_number_and_count(text):
    assert parse_shard("2/8") == Shard(2, 8)
    with pytest.raises(ValueError, match="is not a shard"):
        parse_shard(text)


def test_rows_are_the_results_of_the_cases(load):
    plan = load()
    runner = made_up(plan)
    found = rows(runner.run(np.arange(plan.size)))
    for index, row in enumerate(found):
        case = written_out(plan, index)
        result = evaluate(case, *formula_of(case))
        assert (row["index"], row["id"]) == (index, result.id)
        assert (row["outcome"], row["met"], row["reason"]) == (result.outcome, result.met, result.reason)
        assert row["braking_distance_m"] == result.measures["braking_distance_m"]
    assert [row["parameters.brake.command"] for row in found] == ["80 %", "100 %"] * 3
    assert {row["outcome"] for row in found} == {"pass", "fail"}
    assert found[0]["initial_adhesion_g"] is None  # it has no value
    assert found[0]["values.rail.friction"] == 0.08


def test_the_same_cases_give_the_same_bytes_also_where_chunks_share_a_queue(load):
    plan = load("sample: {size: 90, parameters: {brake.command: {uniform: [60 %, 100 %]}}}\n")
    runner = made_up(plan)
    chunks = [np.arange(0, 31), np.arange(31, 62), np.arange(62, 90)]
    assert runner.run_together(chunks) == [made_up(plan).run(each) for each in chunks]


@pytest.mark.parametrize(
    ("chunks", "jobs", "cases", "sizes"),
    [
        (33, 2, 31, [8, 7, 5, 4, 3, 2, 2, 1, 1]),
        (19, 2, 31, [5, 4, 3, 2, 2, 2, 1]),
        (3, 2, 31, [2, 1]),
        (33, 1, 31, [8, 8, 8, 8, 1]),
        (9, 4, 31, [2, 2, 2, 1, 1, 1]),
        (70, 2, 1024, [1] * 70),
    ],
)
def test_queues_hold_every_chunk_once_and_become_shorter_for_threads_to_end_together(
    chunks, jobs, cases, sizes
):
    queues = queues_of(range(chunks), jobs, cases)
    assert [chunk for queue in queues for chunk in queue] == list(range(chunks))
    assert [len(queue) for queue in queues] == sizes


@pytest.mark.parametrize(
    ("jobs", "queues"), [(1, [8, 8, 8, 8]), (2, [8, 6, 5, 4, 3, 2, 2, 1, 1]), (100, [1] * 32)]
)
def test_threads_take_queues_of_chunks_that_come_out_in_order(load, jobs, queues):
    plan = load("sample: {size: 1000, parameters: {brake.command: {uniform: [60 %, 100 %]}}}\n")
    sizes = []

    def simulate(parameters, own, rail):
        sizes.append(len(parameters))
        return formula(parameters, own, rail)

    written = []
    runner, selection = made_up(plan, simulate), CaseSelection(plan)
    run_on_threads(runner, selection, range(32), jobs, lambda number, _: written.append(number))
    assert written == list(range(32))
    assert sorted(sizes) == sorted(31 * chunks for chunks in queues)


def test_chunks_are_summarised_in_their_order_whatever_the_order_in_which_they_are_finished(
    load, tmp_path, monkeypatch
):
    plan = load("sample: {size: 80, parameters: {brake.command: {uniform: [60 %, 100 %]}}}\n")
    selection, runner = CaseSelection(plan), made_up(plan)
    store, ends = ChunkStore(tmp_path), []

    def run_in_disorder(_, selection, numbers, jobs, write_chunk):
        for number in sorted(numbers, key=[4, 0, 1, 3].index):
            write_chunk(number, runner.run(selection.chunk(number)))

    store.open({"sweep": plan.name}, restart=False)
    store.write(2, runner.run(selection.chunk(2)))
    monkeypatch.setattr(chunked, "run_on_threads", run_in_disorder)
    request = SweepRequest(selection, {"sweep": plan.name}, tmp_path, jobs=1)
    run_missing_chunks(request, store, Observer(), ends.append)
    assert ends == [0, 1, 3, 5]
    whole = result_of(selection, store)
    with summarized(selection, store, None, ["braking_distance_m"]) as summary:
        for end in ends:
            summary.add_up_to(end)
        assert summary.result().result == whole


def test_a_case_that_fails_or_is_rejected_is_a_row_with_its_reason(load):
    def breaks(parameters, own, rail):
        if (rail[:, 1, 0] == 0.10).any():
            raise ZeroDivisionError("no wheel load")
        return formula(parameters, own, rail)

    plan = load()
    found = rows(made_up(plan, breaks).run(np.arange(plan.size)))
    assert [row["outcome"] == "error" for row in found] == [
        row["values.rail.friction"] == 0.10 for row in found
    ]
    assert found[2]["reason"] == "ZeroDivisionError: no wheel load"
    assert found[2]["braking_distance_m"] is None
    plan = load("matrix: {simulation.time_step: [0.5 ms, 0.4 ms], controller.cycle_time: [10 ms, 5 ms]}\n")
    found = rows(made_up(plan).run(np.arange(4)))
    assert [row["outcome"] for row in found].count("error") == 1
    reason = "simulation.time_step: 0.4 ms does not divide the controller cycle of 5 ms"
    assert found[3]["reason"] == reason
    assert not math.isnan(found[0]["braking_distance_m"])
