"""The benchmarks compare what is the same, read the records of the rig, and say what keeps its bound."""

import sys
from pathlib import Path

import pytest

from uictest.rig import run_in_process

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(autouse=True)
def benchmarks_on_path(monkeypatch):
    """The benchmarks are scripts beside each other; they are found as when one of them is run."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    yield
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(BENCHMARKS)):
            del sys.modules[name]


def test_the_python_twin_has_the_bits_of_the_built_in_controller(tmp_path, monkeypatch):
    import controllers as benchmark

    monkeypatch.chdir(tmp_path)
    with benchmark.python_class(tmp_path) as written:
        stops = [benchmark.inputs_of(each) for each in (benchmark.outside(written, "threshold"), "threshold")]
    ours, theirs = (run_in_process(stop).measures for stop in stops)
    assert benchmark.bits_of(ours) == benchmark.bits_of(theirs)


@pytest.mark.parametrize(
    ("limit", "bound", "text", "kept"),
    [
        ("at_most_times", 2.0, "2.00 times", True),
        ("at_most_times", 1.9, "2.00 times", False),
        ("at_most_more", 0.5, "0.500 s more", True),
        ("at_most_more", 0.4, "0.500 s more", False),
        ("stops_per_second", 1.0, "1.0 stops/s", True),
        ("stops_per_second", 1.1, "1.0 stops/s", False),
        ("rate_of_cases", 0.5, "0.50 of it", True),
        ("rate_of_cases", 0.6, "0.50 of it", False),
    ],
)
def test_a_bound_is_met_or_missed(limit, bound, text, kept):
    from timing import Comparison

    import controllers as benchmark

    line = getattr(benchmark, limit)(bound).text(Comparison([1.0, 1.0], [0.5, 0.5]))
    assert text in line
    assert line.endswith("met" if kept else "MISSED")


def test_each_row_is_printed_as_soon_as_its_sweep_has_run(monkeypatch, capsys):
    import growth

    printed = []

    def timed_sweep(cases, jobs):
        printed.append(len(capsys.readouterr().out.splitlines()))
        return growth.Run(cases, jobs, 10.0 / jobs, 10.0, 0.3)

    monkeypatch.setattr(growth, "timed_sweep", timed_sweep)
    runs = growth.table([100, 1000], [2, 1])
    assert printed == [1, 1, 1, 1]  # the heading, then the row of the sweep before
    assert [(run.cases, run.jobs) for run in runs] == [(100, 1), (100, 2), (1000, 1), (1000, 2)]
    assert capsys.readouterr().out.split()[-1] == "2.00"


def test_the_reduced_rig_reads_the_records_of_the_rig():
    from reduced_model import integrated_seconds
    from stops import slide_test

    assert integrated_seconds(slide_test(), 0.05) == 0.05
