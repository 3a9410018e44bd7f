import dataclasses
import json
import math
import subprocess
import sys

import pytest

from uictest.core.measures import STOP_COLUMNS
from uictest.judging.evaluation import (
    EffectivePart,
    Parameter,
    cases_document,
    error_result,
    evaluate,
    result_document,
    results_of,
    to_json,
)

from ..measures.catalogue.conftest import stop, wheelsets
from .conftest import case, scenario, shipped

CASE = [
    *("id", "scenario", "parameters", "expect", "outcome", "reason", "criteria", "measures", "wheelsets"),
    "parts",
]
STATEMENTS = ["test_validity", "requirement_status"]
MEASURES = """
braking_distance_m corrected_distance_m braking_time_s mean_deceleration_mps2 build_up_time_s
deceleration_distance_m developed_deceleration_mps2 reference_distance_m distance_over_reference
initial_adhesion_g adhesion_utilisation minimum_deceleration_mps2 maximum_deceleration_mps2
deceleration_bogie_1_mps2 deceleration_bogie_2_mps2 sliding_share track_brake_energy_kj
track_brake_time_s reservoir_minimum_bar air_consumed_nl reservoir_margin_bar energy_residual
air_residual air_energy_residual
"""
WHEELSET = """
adhesion_utilisation maximum_slide sliding_time_s slid_distance_m contact_energy_kj locked_time_s
valve_actuations maximum_clamping_force_n maximum_disc_temperature_degc dynamic_energy_kj sand_laid_kg
sand_in_30_s_kg longest_sanding_s air_vented_nl
"""


@pytest.fixture
def results():
    slip_test = case(scenario(shipped("uic-541-05-appendix-b"), condition="wet"))
    dry = case(scenario(shipped("uic-541-05-appendix-b"), shipped("uictest-stop")))
    results = [
        evaluate(dry, stop(), wheelsets(0.0, 0.0, 0.0, 0.0), duration=1.5),
        evaluate(slip_test, stop(minimum_deceleration=math.nan), wheelsets(0.5, math.nan, 0.5, 0.5)),
        error_result(slip_test, "diverged"),
    ]
    return [dataclasses.replace(result, id=f"case-{n}") for n, result in enumerate(results)]


def test_the_document_is_json_for_any_reader_with_the_fields_of_the_interface(results):
    def refuse(constant):
        raise AssertionError(f"{constant} is not JSON")

    document = json.loads(to_json(result_document(results, seed=7, drift=math.nan)), parse_constant=refuse)
    assert (document["schema"], document["kind"]) == ("uictest/result/2", "run")
    assert (document["seed"], document["drift"]) == (7, None)
    assert document["cases"][1]["measures"]["initial_adhesion_g"] is None
    assert document["cases"][2]["measures"] is None
    form = result_document(results)["cases"][0]
    assert list(form) == [*CASE, *STATEMENTS]
    assert list(form["measures"]) == MEASURES.split()
    assert list(form["wheelsets"][0]) == WHEELSET.split()


def test_which_controller_answered_and_the_noise_are_there_only_where_known_and_come_back(results):
    told = dataclasses.replace(
        results[0], controller_version="wsp 1.2", controller_contract=2, case_sha256="ab" * 32
    )
    document = json.loads(to_json(result_document([told, *results[1:]])))
    first, *others = document["cases"]
    assert list(first) == [*CASE, "controller_version", "controller_contract", "case_sha256", *STATEMENTS]
    assert [list(case) for case in others] == [[*CASE, *STATEMENTS]] * 2
    back, *_ = results_of(document)
    told = back.controller_version, back.controller_contract, back.case_sha256
    assert told == ("wsp 1.2", 2, "ab" * 32)
    simulated = dataclasses.replace(results[0], noise_key="00c0ffee")
    document = json.loads(to_json(result_document([simulated, *results[1:]])))
    assert [case.get("noise_key") for case in document["cases"]] == ["00c0ffee", None, None]
    assert results_of(document)[0].noise_key == "00c0ffee"


def test_requirements_are_there_only_where_some_are_named_and_come_back(results):
    first = results[0]
    verdict = dataclasses.replace(first.criteria[0], requirements=("BR-2", "BR-1"))
    ids = {"requirements": ("BR-9",), "test_case": "WSP-TC-7"}
    named = dataclasses.replace(first, criteria=(verdict, *first.criteria[1:]), **ids)
    document = json.loads(to_json(result_document([named, *results[1:]])))
    case, *others = document["cases"]
    assert list(case) == [*CASE, "requirements", "test_case", *STATEMENTS]
    assert [list(each) for each in others] == [[*CASE, *STATEMENTS]] * 2
    assert [each.get("requirements") for each in case["criteria"][:2]] == [["BR-2", "BR-1"], None]
    back, *_ = results_of(document)
    assert (back.requirements, back.test_case) == (("BR-9",), "WSP-TC-7")
    assert back.criteria[0].requirements == ("BR-2", "BR-1")


def test_results_come_back_from_their_document_however_long_they_took_and_null_is_no_value(results):
    back = results_of(json.loads(to_json(result_document(results))))
    assert cases_document(back) == cases_document(results)
    assert back[0].criteria == results[0].criteria
    assert back[0].wheelsets == results[0].wheelsets
    slower = [dataclasses.replace(result, duration=60.0) for result in results]
    assert to_json(result_document(slower)) == to_json(result_document(results))
    document = result_document(results)
    document["cases"][0]["measures"] = dict.fromkeys(STOP_COLUMNS) | {"braking_distance_m": 465.0}
    read = results_of(document)[0].measures
    assert read["braking_distance_m"] == 465.0
    assert all(math.isnan(value) for name, value in read.items() if name != "braking_distance_m")


PART = EffectivePart(
    *("controller", "controller", "threshold", "threshold"),
    (
        Parameter("controller.slip_threshold", 0.8, "m/s", "0.8 m/s", "user", "", True, 1.146, "1.146 m/s"),
        Parameter("controller.hold_limit", 2.0, "s", "2 s", "chosen", "ours"),
    ),
    ("controller.gone",),
    {"ours": "A surrogate."},
)


def test_a_part_of_many_cases_is_in_the_document_once_and_comes_back_and_another_is_refused(results):
    results = [dataclasses.replace(result, parts={"controller": PART}) for result in results]
    document = json.loads(to_json(result_document(results)))
    assert list(document["parts"]) == [PART.id]
    assert [case["parts"] for case in document["cases"]] == [{"controller": PART.id}] * 3
    assert [result.parts["controller"] for result in results_of(document)] == [PART] * 3
    with pytest.raises(ValueError, match="parts"):
        results_of({**document, "parts": {}})


@pytest.mark.parametrize("content", [{}, {**dict.fromkeys(STOP_COLUMNS), "mood": 1.0}, [465.0]])
def test_other_columns_are_refused(results, content):
    document = result_document(results)
    document["cases"][0]["measures"] = content
    with pytest.raises(ValueError, match=r"cases\.0\.measures: .*should have the columns braking_distance_m"):
        results_of(document)


def test_a_measure_that_was_added_later_is_not_available_in_older_documents(results):
    document = result_document(results)
    first, second, _ = document["cases"]
    for simulated in (first, second):
        del simulated["measures"]["air_residual"]
        for columns in simulated["wheelsets"]:
            del columns["sand_laid_kg"]
    read = results_of(document)[0]
    assert math.isnan(read.measures["air_residual"])
    assert [math.isnan(wheelset["sand_laid_kg"]) for wheelset in read.wheelsets] == [True] * 4
    assert read.measures["braking_distance_m"] == results[0].measures["braking_distance_m"]
    # A column that only some stops lack was lost.
    lost = (first["measures"], "braking_time_s"), (second["wheelsets"][3], "locked_time_s")
    for columns, name in lost:
        value = columns.pop(name)
        with pytest.raises(ValueError, match="cases: all stops should have the same columns of measures"):
            results_of(document)
        columns[name] = value


@pytest.mark.parametrize("value", ["far", True, 10**400])
def test_a_measure_that_is_no_number_is_refused(results, value):
    document = result_document(results)
    document["cases"][0]["measures"] = dict.fromkeys(STOP_COLUMNS, value)
    with pytest.raises(ValueError, match=r"cases\.0\.measures: .*should hold numbers only"):
        results_of(document)


BARE = {
    "id": "a",
    "scenario": "a.yaml",
    "parameters": {},
    "expect": "pass",
    "outcome": "error",
    "criteria": [],
    "measures": None,
    "wheelsets": [],
}
HEAD = {"schema": "uictest/result/2", "kind": "run"}


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({}, "expected schema 'uictest/result/2', kind 'run', found no schema"),
        ({"schema": "uictest/result/2"}, "found schema 'uictest/result/2'"),
        ({"schema": "uictest/result/1"}, "written by uictest 0.2 or older: run it again"),
        ({**HEAD, "cases": []}, "parts: Input should be a valid dictionary"),
        ({**HEAD, "parts": {}}, "'cases'"),
        ({**HEAD, "parts": {}, "cases": [{"id": "a"}]}, "cases.0: .*'criteria' is missing"),
        ({**HEAD, "parts": {}, "cases": [None]}, "cases.0"),
        ({**HEAD, "parts": {}, "cases": [BARE | {"met": True}]}, "cases.0.met: Unexpected"),
        ({**HEAD, "parts": {}, "cases": [BARE | {"outcome": "lost"}]}, "cases.0.outcome: Input"),
        ({**HEAD, "parts": {}, "cases": [BARE, BARE]}, "two cases have the id 'a'"),
        ({**HEAD, "cases": [BARE], "parts": {"a": {}}}, "parts.a.kind: Field req"),
    ],
)
def test_another_document_is_refused(document, message):
    with pytest.raises(ValueError, match=message):
        results_of(document)


def test_importing_the_room_imports_nothing_heavy():
    heavy = ("pandas", "pyarrow", "scipy", "pydantic", "numpy")
    code = f"import sys, uictest.judging.evaluation; print([m for m in {heavy} if m in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout
    assert found.strip() == "[]"
