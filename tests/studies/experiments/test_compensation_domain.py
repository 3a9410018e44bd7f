import math
from types import SimpleNamespace

import numpy as np
import pytest

from studies.experiments import compensation_domain
from studies.experiments.compensation_domain import worst_by_cell
from studies.model_errors import JudgedConditions, ReplayErrors, SettingErrors, judged_cases, replay_errors
from studies.quantity import OwnBand, SourceBand
from studies.study import STUDIES, run_study
from uictest.plans.scenario import COMPENSATION_SETTINGS

FEW = JudgedConditions(frictions=(0.11,), positions=("R", "emergency"), wheelsets=(2,), seeds=(31,))
QUANTITIES = {quantity.key: quantity for quantity in STUDIES["compensation-domain"].quantities}


@pytest.fixture(scope="module")
def replays(stop_runner):
    return replay_errors(stop_runner, judged_cases(stop_runner, FEW), FEW.wheelsets)


def test_the_papers_own_method_has_the_papers_band_and_ours_has_one_of_ours():
    banded = {key: each.band for key, each in QUANTITIES.items() if each.band is not None}
    papers = ("median_full", "worst_full", "median_cylinder", "worst_cylinder")
    assert {key for key, band in banded.items() if isinstance(band, SourceBand)} == {
        *(f"pressure_error_{each}" for each in papers),
        *("force_error_median_full", "force_error_worst_full"),
    }
    assert {key: band.upper for key, band in banded.items() if isinstance(band, OwnBand)} == {
        "pressure_error_median_thermal": 1.0,
        "pressure_error_worst_thermal": 2.0,
        "force_error_worst_thermal": 8.0,
    }


def test_our_compensation_keeps_the_bounds_and_hysteresis_changes_the_force_alone(replays):
    errors = [each.errors["thermal"] for each in replays]
    assert max(each.pressure_error for each in errors) < 2.0
    assert max(each.force_error for each in errors) < 8.0
    for each in replays:
        assert each.errors["hysteresis"].pressure_error == each.errors["none"].pressure_error
        assert each.errors["hysteresis"].force_error < each.errors["none"].force_error


def test_every_replay_has_a_row_for_every_setting(stop_runner, monkeypatch):
    monkeypatch.setattr(compensation_domain, "judged_conditions", lambda: FEW)
    findings = run_study(STUDIES["compensation-domain"], stop_runner).findings
    table = findings.tables["errors"]
    assert table["position"] == ["R"] * 5 + ["emergency"] * 5
    assert table["setting"] == [*COMPENSATION_SETTINGS] * 2
    columns = ("pressure_error_percent", "setting", "position", "vents")
    rows = list(zip(*(table[key] for key in columns), strict=True))
    worst = max(error for error, setting, *_ in rows if setting == "full")
    assert findings.values["pressure_error_worst_full"].value == worst
    # None of these replays is in position P.
    assert math.isnan(findings.values["pressure_error_venting_thermal_p"].value)
    errors = [error for error, *of in rows if of == ["thermal", "R", True]]
    assert [findings.values["pressure_error_venting_thermal_r"].value] == errors


def test_a_cell_of_the_map_holds_the_worst_of_its_wheelsets():
    def replay(friction, position, error):
        rail, brake = SimpleNamespace(friction=friction), SimpleNamespace(position=position)
        case = SimpleNamespace(scenario=SimpleNamespace(rail=rail, brake=brake))
        return ReplayErrors(case, 1, True, {"full": SettingErrors(error, error, 0.0)})

    made_up = [replay(0.08, "P", 3.0), replay(0.08, "P", 2.0), replay(0.08, "R", 1.0), replay(0.1, "P", 4.0)]
    np.testing.assert_array_equal(worst_by_cell(made_up, "pressure_error", "full"), [[3.0, 1.0], [4.0, 0.0]])
