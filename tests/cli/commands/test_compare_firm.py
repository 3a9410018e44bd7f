"""`uictest compare SCENARIO --over KEY --firm`: whether chosen numbers turn which variant is better."""

import json
import math
import re
from pathlib import Path
from types import SimpleNamespace

import pytest

from uictest.analysis.firmness import COMPARED, Effort, compared
from uictest.runs import firmness

PAD = "brake.system.disc.pad_friction"
VARIANTS = (
    f"rail: {{condition: dry}}\nmatrix: {{{PAD}: ['0.36', {{value: '0.38', range: ['0.30', '0.42']}}]}}\n"
)
FIRM = ("--over", PAD, "--firm")


@pytest.fixture(autouse=True)
def _few(monkeypatch):
    monkeypatch.setattr(firmness, "EFFORT", Effort(blocks=2, block=4, seeds=2, seeds_at_ends=1))


def pairs(call, *arguments):
    answer = call("compare", *arguments, "--firm", "--format", "json")
    document = json.loads(answer.out)
    assert (document["schema"], document["kind"]) == ("uictest/result/2", "firm-variants")
    return document["pairs"]


def test_what_nothing_turns_is_not_said_to_be_firm_in_few_draws(call, scenario):
    """On a dry rail no wheelset slides: there is no contact energy to compare."""
    path = scenario("stop", "rail: {condition: dry}\n")
    variants = ("--over", "brake.command", "--set", "brake.command=90 %,100 %")
    [pair] = pairs(call, path, *variants)
    [distance] = [each for each in pair["quantities"] if each["criterion"] == "braking distance"]
    assert (distance["nominal"], distance["status"], distance["turned"]) == ("fail", "not_shown", 0)
    assert (pair["draws"], pair["infeasible"], pair["on_four_calipers"]) == (8, 0, True)
    assert {each["key"] for each in pair["numbers"]} > {"vehicle.body.mass"}
    assert pair["undecided"] == ["contact energy of the worst wheelset"]
    text = call("compare", path, *variants, "--firm").out
    assert "contact energy of the worst wheelset: neither comes to less" in text


def test_the_text_names_both_sides_and_the_value(call, scenario):
    text = call("compare", scenario("pads", VARIANTS), "--over", PAD, "--firm").out
    [line] = [line for line in text.splitlines() if line.startswith("braking distance: less with pads[")]
    assert re.search(rf"turned by {PAD} below 0\.3(59|6)", line)
    assert "not firm" in line


def assert_the_pads_turn_the_distance(pair):
    """Two brakes that differ in their pads alone stop alike with equal pads: at 0.36."""
    [distance] = [each for each in pair["quantities"] if each["criterion"] == "braking distance"]
    assert (distance["nominal"], distance["status"]) == ("fail", "turns")
    [turn] = distance["turned_by"]
    assert (turn["key"], turn["side"], turn["to"]) == (PAD, "below", "pass")
    assert float(turn["value"]) == pytest.approx(0.36, abs=1.5e-3)
    assert distance["margin"] == pytest.approx(0.36 / 0.38 - 1.0, abs=0.02)


def test_the_page_says_of_each_quantity_how_firm_it_is_and_draws_the_numbers(call, scenario):
    """Every share on the page is that of the JSON, which names what turns where both are alike."""
    page = Path("pair.html")
    document = call(
        *("compare", scenario("pads", VARIANTS), *FIRM, "--format", "json", "--html", str(page)), code=0
    )
    [pair] = json.loads(document.out)["pairs"]
    assert_the_pads_turn_the_distance(pair)
    html = page.read_text("utf-8")
    rows = dict(re.findall(r"<tr[^>]*><th[^>]*>(.*?)</th>(.*?)</tr>", html))
    for quantity in pair["quantities"]:
        cells = [re.sub("<[^>]+>", "", cell) for cell in rows[quantity["criterion"]].split("</td>")]
        side = {"pass": "A", "fail": "B", "same": "neither"}[quantity["nominal"]]
        assert cells[0] == side
        assert float(cells[1]) == pytest.approx(100.0 * quantity["margin"], rel=0.01)
        assert float(cells[3]) == pytest.approx(100.0 * quantity["share"], rel=0.01)
    assert "<svg" in html
    assert f"{len(pair['numbers'])} numbers with a plausible range" in html
    assert "http://" not in re.sub(r"http://www.w3.org/\S+", "", html)


def test_other_values_pair_only_with_equal_ones(call, scenario):
    path = scenario("stop", "rail: {condition: dry}\n")
    found = pairs(
        *(call, path, "--over", "brake.command", "--set", "brake.command=90 %,100 %"),
        *("--set", "rig.wsp=active,bypassed"),
    )
    assert len(found) == 2
    for pair in found:
        assert pair["first"].replace("command=90", "command=100") == pair["second"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--firm"], "say which variants"),
        (["--firm", "--over", "controler"], "no case has a value of 'controler'"),
        (["--firm", "--over", "seed"], "no two cases differ in seed alone"),
        (["other", "--firm", "--over", "seed"], "takes one scenario"),
    ],
)
def test_what_cannot_be_compared_is_refused(call, scenario, arguments, message):
    both_vary = "zip: {seed: [1, 2], brake.command: [90 %, 100 %]}\n"
    answer = call("compare", scenario("stop", both_vary), *arguments, code=4)
    assert message in answer.err


def test_values_are_set_only_where_stops_are_run(call, scenario):
    call("run", scenario("stop", "rail: {condition: dry}\n"))
    answer = call("compare", "reports/latest", "--over", "seed", "--set", "seed=1,2", code=4)
    assert "goes with --firm" in answer.err


def test_the_folder_of_a_run_is_no_scenario(call, scenario):
    call("run", scenario("stop", "rail: {condition: dry}\n"))
    answer = call("compare", "reports/latest", "--firm", "--over", "seed", code=4)
    assert "name a scenario, not the folder of a run" in answer.err


def test_a_stop_without_standstill_compares_with_nothing():
    def stop(distance):
        measures = {"braking_distance_m": distance, "air_consumed_nl": 1.0}
        return SimpleNamespace(measures=measures, wheelsets=({"contact_energy_kj": 0.0},))

    assert compared(stop(100.0), stop(math.nan)).outcome == "error"
    assert "contact energy of the worst wheelset" not in compared(stop(100.0), stop(110.0)).margins
    both = compared(stop(100.0), stop(110.0))
    assert both.statuses == dict(zip(COMPARED, ("pass", "same", "same"), strict=True))
    assert both.margins["braking distance"] == pytest.approx(0.1)
