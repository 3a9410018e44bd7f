import pytest

from uictest.plans.scenario import load, named_requirements
from uictest.plans.series import load_series
from uictest.running.campaign import CoveredRequirement, Verifier, requirement_coverage

SHORT = "id: short, layer: requirement, measure: braking_distance, upper: 900 m"
PROFILE = f"""\
criteria: {{name: own, criteria: [{{{SHORT}, applies: {{rail_condition: [dry]}}, requirements: [BR-2]}}]}}
"""


@pytest.fixture
def cases(tmp_path):
    """The cases of scenarios called a, b, ..., one per text."""

    def write_and_load(*texts):
        for name, text in zip("abc", texts, strict=False):
            head = f"schema: uictest/scenario/1\nname: {name}\ninitial_speed: 120 km/h\n"
            (tmp_path / f"{name}.yaml").write_text(head + text)
        return load([tmp_path])

    return write_and_load


def test_a_scenario_covers_its_requirements_in_all_of_its_cases(cases):
    matrix = "requirements: [BR-1]\nmatrix: {brake.command: [80 %, 90 %]}\n"
    coverage = requirement_coverage(cases(matrix, "requirements: [BR-1]\n"))
    of_matrix = Verifier("scenario", "a", cases=("a[command=80]", "a[command=90]"))
    assert coverage == [CoveredRequirement("BR-1", (of_matrix, Verifier("scenario", "b", cases=("b",))))]


def test_a_criterion_covers_its_requirement_only_where_it_applies(cases):
    coverage = requirement_coverage(cases(PROFILE, f"{PROFILE}rail: {{condition: wet}}\n"))
    assert coverage == [CoveredRequirement("BR-2", (Verifier("criterion", "short", "own", ("a",)),))]


@pytest.mark.parametrize("text", ["rail: {condition: wet}\n", "expect: fail\n"])
def test_a_requirement_that_no_case_tests_is_not_covered(cases, text):
    (requirement,) = requirement_coverage(cases(PROFILE + text))
    assert requirement == CoveredRequirement("BR-2", (Verifier("criterion", "short", "own"),))
    assert not requirement.covered


@pytest.mark.parametrize(
    "bound",
    ["scope: series, measure: k_wet, lower: 0.8", "measure: braking_time, upper: 120 % of the dry stop"],
)
def test_a_criterion_that_a_series_is_judged_by_covers_nothing_in_a_case(cases, bound):
    own = f"{{id: own, layer: requirement, {bound}, requirements: [BR-2]}}"
    (case,) = cases(f"criteria: {{name: own, criteria: [{own}]}}\n")
    (requirement,) = requirement_coverage([case])
    assert not requirement.covered
    assert named_requirements(case.scenario) == ()


def test_listed_requirements_that_nothing_names_are_there_in_the_order_of_ids(cases):
    coverage = requirement_coverage(cases("requirements: [BR-9]\n"), ["BR-10", "BR-9", "BR-8"])
    covered = [(each.id, each.covered) for each in coverage]
    assert covered == [("BR-8", False), ("BR-9", True), ("BR-10", False)]


SERIES = """\
schema: uictest/series/1
name: acceptance
dry: dry.yaml
wet: wet.yaml
criteria: own.yaml
"""
OF_SERIES = """\
schema: uictest/criteria/1
name: of-series
criteria:
  - {id: k-wet, layer: requirement, scope: series, measure: k_wet, lower: 0.8, requirements: [BR-1]}
  - {id: longest, layer: requirement, measure: braking_distance, upper: LIMIT, requirements: [BR-2]APPLIES}
  - {id: slides, layer: validity, measure: braking_time, lower: 1 s, requirements: [BR-3]}
"""


def verifiers(folder, limit, applies, text):
    for name in ("dry", "wet"):
        content = f"rail: {{condition: {name}}}\ncriteria: uictest-stop\nrequirements: [BR-OF-STOP]\n"
        head = f"schema: uictest/scenario/1\nname: {name}\ninitial_speed: 120 km/h\n"
        (folder / f"{name}.yaml").write_text(head + content)
    (folder / "own.yaml").write_text(OF_SERIES.replace("LIMIT", limit).replace("APPLIES", applies))
    path = folder / "a.series.yaml"
    path.write_text(SERIES + text)
    return {each.id: each.verifiers for each in requirement_coverage([], series=load_series(path))}


def test_a_series_covers_its_requirements_and_those_of_criteria_that_it_has_a_verdict_on(tmp_path):
    """A criterion of validity decides which stops count; requirements of stops are none of the series."""
    ids = ("acceptance",)
    assert verifiers(tmp_path, "900 m", "", "requirements: [BR-9]\n") == {
        "BR-1": (Verifier("criterion", "k-wet", "of-series", series=ids),),
        "BR-2": (Verifier("criterion", "longest", "of-series", series=ids),),
        "BR-3": (Verifier("criterion", "slides", "of-series"),),
        "BR-9": (Verifier("series", "acceptance", series=ids),),
    }


@pytest.mark.parametrize(
    ("limit", "condition", "covered"),
    [
        ("900 m", "dry", True),
        ("900 m", "wet", True),
        ("900 m", "contaminated", False),
        ("150 % of the dry stop", "dry", False),
        ("150 % of the dry stop", "wet", True),
    ],
)
def test_a_criterion_of_stops_covers_where_it_applies_to_a_stop_that_it_judges(
    tmp_path, limit, condition, covered
):
    (verifier,) = verifiers(tmp_path, limit, f", applies: {{rail_condition: [{condition}]}}", "")["BR-2"]
    assert bool(verifier.series) is covered


def test_the_series_of_a_file_are_one_verifier_and_one_that_must_not_pass_verifies_as_a_whole(tmp_path):
    text = "requirements: [BR-9]\nexpect: {fail: [k-wet]}\nmatrix: {controller: [threshold, slip-band]}\n"
    found = verifiers(tmp_path, "900 m", "", text)
    ids = ("acceptance[controller=threshold]", "acceptance[controller=slip-band]")
    assert found["BR-9"] == (Verifier("series", "acceptance", series=ids),)
    assert found["BR-1"] == (Verifier("criterion", "k-wet", "of-series"),)
