"""The benchmark of controllers from outside compares what is the same, and says what keeps its bound."""

import pytest

from uictest.rig import run_in_process


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
