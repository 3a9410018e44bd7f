"""Weaknesses that were planted in a C controller from outside are found, and made small."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from tests.c_compiler import c_compiler

FILE = Path(__file__).parents[2] / "benchmarks/search.py"
specification = spec_from_file_location("search_benchmark", FILE)
assert specification is not None
assert specification.loader is not None
benchmark = module_from_spec(specification)
specification.loader.exec_module(benchmark)
WEAK = [name for name in benchmark.WEAKNESSES if name != "sound"]


def check(name, folder, stops):
    c_compiler()
    outcome = benchmark.searched(benchmark.write_weak_scenario(folder / "weak", name), stops)
    [case, *_] = outcome.found
    assert (case.target, case.off_nominal <= 2, case.failing >= 8) == ("locked-wheels", True, True)


def test_a_weakness_at_full_load_is_found(tmp_path):
    check("pressure above 3.7 bar", tmp_path, 500)


@pytest.mark.slow
@pytest.mark.parametrize("name", WEAK)
def test_each_weakness_is_found_within_2000_stops(name, tmp_path):
    check(name, tmp_path, 2000)


@pytest.mark.slow
def test_the_sound_controller_has_no_such_weakness(tmp_path):
    c_compiler()
    outcome = benchmark.searched(benchmark.write_weak_scenario(tmp_path / "sound", "sound"), 2000)
    assert outcome.found == ()
