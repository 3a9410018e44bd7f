"""One stop_runner for all tests of the studies: a stop or a study that several of them need is run once."""

from functools import cache

import pytest

from studies.quantity import OwnBand, SourceBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner
from studies.study import STUDIES, Study, StudyFindings, StudyResult, run_study
from uictest import CaseResult
from uictest.plans.scenario import PASS

OURS = OwnBand(lower=16.5, upper=19.0, reason="ours")
THEIRS = SourceBand(upper=2.0, below=True)


@pytest.fixture(scope="session")
def stop_runner():
    return StopRunner(jobs=2)


@pytest.fixture(scope="session")
def result(stop_runner):
    """Run a study of the catalogue, or return its earlier result."""
    return cache(lambda name: run_study(STUDIES[name], stop_runner))


@pytest.fixture(scope="session")
def stop():
    """Make a stop of which only the actuations of the four valves, and some measures, are known."""

    def make(*vents, **measures):
        wheelsets = tuple({"valve_actuations": count, "maximum_slide": 0.0} for count in vents)
        known = {"braking_distance_m": 0.0, "braking_time_s": 0.0, "air_consumed_nl": 0.0, **measures}
        return CaseResult("stop", "", {}, PASS, "pass", measures=known, wheelsets=wheelsets)

    return make


@pytest.fixture
def made_up():
    """A study of three quantities: one holds, one misses, one has no band and was not found."""
    quantities = (
        StudyQuantity("time", "braking time", "s", "17.6 s", status="calibrated", band=OURS),
        StudyQuantity(*("share", "[bold]share", "%", "below 2 %"), status="predicted", band=THEIRS, digits=2),
        StudyQuantity("count", "actuations", status="predicted", digits=0),
    )
    values = {
        "time": StudyValue(18.12, 17.9, 18.34),
        "share": StudyValue(2.0),
        "count": StudyValue(float("nan"), float("nan"), float("nan")),
    }
    data = {"data": {"time_s": [0.0, 0.5], "what": ["a, b", None]}}
    findings = StudyFindings(values, data, notes=("Made up.",))
    study = Study("made-up", "A made-up study", "17.6 s", quantities, lambda stop_runner: findings)
    return StudyResult(study, findings)
