from dataclasses import replace

import pytest

from studies.quantity import StudyValue
from studies.stop_runner import StopRunner
from studies.study import StudyFindings, StudyResult, run_study


def test_one_figure_outside_its_band_decides(made_up):
    assert [comparison.result for comparison in made_up.comparisons] == ["holds", "misses", "shown"]
    assert (made_up.result, made_up.fails) == ("misses", True)


def test_a_study_without_a_band_is_only_shown(made_up):
    unbounded = replace(made_up.study, quantities=made_up.study.quantities[2:])
    assert StudyResult(unbounded, made_up.findings).result == "shown"


def test_a_study_must_find_all_its_quantities(made_up):
    study = replace(made_up.study, run=lambda stop_runner: StudyFindings({"time": StudyValue(18.0)}))
    with pytest.raises(KeyError, match="share, count"):
        run_study(study, StopRunner())
