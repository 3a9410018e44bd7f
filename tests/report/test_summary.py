"""The one summary: failures grouped by cause, conditions that cases share, what is close."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import example, given, strategies as st

from uictest.judging.evaluation import (
    EffectivePart,
    Parameter,
    RailValidity,
    Repeats,
    Sensitivity,
    VerdictInterval,
)
from uictest.plans.scenario import expectation_of
from uictest.report import BaselineComparison, Difference, RunManifest
from uictest.report.case_lines import MOST_CLOSE
from uictest.report.conditions import shared_conditions
from uictest.report.page import page_html
from uictest.report.run_publication import publication_of_run
from uictest.report.run_text import last_lines, run_lines
from uictest.report.summary import case_causes, close_lines, run_summary
from uictest.report.traces.trace import trace_of
from uictest.report.verdict_sentences import explanation

from .builders import HOSTILE, make_content, make_recording, make_result, make_verdict
from .made_up_series import MISSED

FRICTIONS, COMMANDS = ("0.06", "0.08", "0.10"), ("60 %", "80 %", "100 %")


def locked(value, **changes):
    """The longest lock of wheelset 2 against a limit of 1 s."""
    status = "fail" if value > 1.0 else "pass"
    content = {
        "id": "locked-wheels",
        "layer": "requirement",
        "measure": "longest_lock",
        "value": value,
        "unit": "s",
        "lower": None,
        "upper": 1.0,
        "margin": 1.0 - value,
        "status": status,
        "reason": f"locked for {value:g} s" if value > 1.0 else "",
        "definition": {"wheelsets": "all"},
        "missed_by": (2,) if value > 1.0 else (),
    }
    return make_verdict(**content | changes)


def no_slide(value):
    """A share of sliding against the 35 % that a slip test needs."""
    status = "fail" if value < 35.0 else "pass"
    margin = value - 35.0
    return make_verdict(
        id="minimum-slide", value=value, unit="%", lower=35.0, upper=None, margin=margin, status=status
    )


def case(friction, command, outcome="pass", *verdicts, **changes):
    """A case of a sweep over friction and command."""
    parameters = {"rail.friction": friction, "brake.command": command}
    name = f"slip[friction={friction},command={command.removesuffix(' %')}]"
    content = {"id": name, "scenario": "slip.yaml", "parameters": parameters, "outcome": outcome}
    return make_result(**content | {"criteria": verdicts or (locked(0.0),)} | changes)


def nine(failing):
    """Nine cases; those in `failing` have their outcome and verdicts from there."""
    return [case(*values, *failing.get(values, ())) for values in product(FRICTIONS, COMMANDS)]


def test_cases_that_fail_alike_are_one_group_and_the_worst_speaks():
    failing = {
        (friction, command): ("fail", locked(lock))
        for (friction, command), lock in {
            ("0.06", "60 %"): 3.0,
            ("0.06", "80 %"): 49.0,
            ("0.06", "100 %"): 7.0,
            ("0.08", "80 %"): 5.0,
            ("0.08", "100 %"): 2.0,
        }.items()
    }
    failing["0.10", "60 %"] = ("invalid", no_slide(6.0))
    cases = nine(failing)
    summary = run_summary(make_content(*cases))
    locks, invalid = summary.groups
    assert (locks.kind, len(locks.ids), locks.worst) == ("fail", 5, "slip[friction=0.06,command=80]")
    assert locks.block.heading == (
        "5 cases miss requirements: friction 0.06; friction 0.08 at command 80 % and 100 %"
    )
    assert locks.block.lines == ["locked-wheels in all 5, worst 49 s (limit 1 s)"]
    assert locks.command == "uictest run slip.yaml -k 'slip[friction=0.06,command=80]'"
    assert invalid.block.heading == "slip[friction=0.10,command=60] is not a valid test"
    assert invalid.block.lines == ["minimum-slide: 6 % (35 % needed)"]
    assert summary.headline == (
        "5 of 9 cases failed: slip (locked-wheels); 1 is not a valid test: slip (minimum-slide)"
    )


def test_sides_of_one_limit_are_two_groups_and_a_shared_criterion_joins_cases():
    short = make_verdict(value=400.0, status="fail", layer="requirement", margin=-40.0)
    long = make_verdict(value=600.0, status="fail", layer="requirement", margin=-110.0)
    apart = make_content(
        case("0.06", "60 %", "fail", short), case("0.06", "80 %", "fail", long), case("0.08", "60 %")
    )
    assert [len(group.ids) for group in run_summary(apart).groups] == [1, 1]
    joined = make_content(
        case("0.06", "60 %", "fail", short),
        case("0.06", "80 %", "fail", long, locked(9.0)),
        case("0.08", "60 %", "fail", short, locked(2.0)),
    )
    [group] = run_summary(joined).groups
    # 9 s is eight limits too long, 600 m a fifth, 400 m less
    assert [(miss.verdict.id, miss.verdict.value, len(miss.cases)) for miss in group.misses] == [
        ("locked-wheels", 9.0, 2),
        ("braking-distance", 600.0, 1),
        ("braking-distance", 400.0, 2),
    ]


@pytest.mark.parametrize(
    ("chosen", "words"),
    [
        pytest.param({("0.06", c) for c in COMMANDS}, "friction 0.06", id="one-value"),
        pytest.param(
            {(f, c) for f in FRICTIONS[:2] for c in COMMANDS[1:]},
            "friction 0.06 and 0.08 at command 80 % and 100 %",
            id="a-block",
        ),
        pytest.param(set(product(FRICTIONS, COMMANDS)), "all cases", id="all"),
        pytest.param(
            set(product(FRICTIONS, COMMANDS)) - {("0.10", "60 %")},
            "all but friction 0.10 at command 60 %",
            id="all-but-one",
        ),
        pytest.param(
            {("0.06", "60 %"), ("0.08", "80 %"), ("0.10", "100 %")},
            "friction 0.06 at command 60 %; friction 0.08 at command 80 %; friction 0.10 at command 100 %",
            id="a-diagonal",
        ),
    ],
)
def test_shared_conditions_name_these_cases_and_no_other(chosen, words):
    cases = [case(*values) for values in product(FRICTIONS, COMMANDS)]
    members = [each for each in cases if tuple(each.parameters.values()) in chosen]
    assert shared_conditions(members, cases) == words


def test_a_key_that_only_some_cases_have_is_named_where_it_is_missing():
    """As where one of two runs that are compared has one more key in its matrix."""
    few = make_result(id="s[f=1]", parameters={"rail.f": "1"})
    more = [make_result(id=f"s[f=1,c={c}]", parameters={"rail.f": "1", "brake.c": c}) for c in ("8", "9")]
    texts = [shared_conditions(members, [few, *more]) for members in ([few], more, [few, more[0]])]
    assert texts == ["without c", "c 8 and 9", "c none and 8"]


MORE = list(product((*FRICTIONS, "0.12"), (*COMMANDS, "40 %")))


@given(st.sets(st.sampled_from(MORE), min_size=1))
@example({MORE[0], MORE[5], MORE[10], MORE[15]})
def test_conditions_of_any_cases_are_true_of_them_alone(chosen):
    """Read back by an oracle that knows only the words: each clause is a product of values."""
    cases = [case(*values) for values in MORE]
    members = [each for each in cases if tuple(each.parameters.values()) in chosen]
    words = shared_conditions(members, cases)
    if words.endswith("16 cases"):  # counted, as no short description is true
        assert words == f"{len(chosen)} of 16 cases"
        return

    def meant(clause):
        return {
            (f, c)
            for f, c in MORE
            if ("friction" not in clause or f in clause) and ("command" not in clause or f" {c}" in clause)
        }

    clauses = [] if words == "all cases" else words.removeprefix("all but ").split("; ")
    named = set().union(*map(meant, clauses))
    assert chosen == (set(MORE) - named if words.startswith("all") else named)


def test_several_scenarios_are_named_and_a_run_that_is_fine_says_so():
    other = make_result(id="dry", scenario="dry.yaml", parameters={}, outcome="fail", criteria=(locked(2.0),))
    cases = [case("0.06", "60 %", "fail", locked(3.0)), case("0.08", "60 %"), other]
    assert shared_conditions([cases[0], other], cases) == "slip at friction 0.06; dry"
    assert run_summary(make_content(*cases)).headline == "2 of 3 cases failed: slip, dry (locked-wheels)"
    fine = run_summary(make_content(cases[1]))
    assert (fine.groups, fine.headline) == ([], "1 case: 1 pass")


def test_errors_and_unexpected_passes_say_why():
    crashed = case("0.06", "60 %", "error", criteria=(), reason="the controller crashed: killed by SIGSEGV")
    passing = case("0.08", "60 %", expect="fail")
    errors, passes = run_summary(make_content(crashed, passing)).groups
    assert (errors.kind, errors.block.lines) == ("error", ["the controller crashed: killed by SIGSEGV"])
    assert (passes.kind, passes.block.lines) == ("unexpected", ["pass, expected: fail"])


BOTH = VerdictInterval(5.0, 9.0, "pass"), VerdictInterval(10.0, 15.0, "fail")
TURNS = (Sensitivity("cutoff", "km/h", 5.0, 15.0, BOTH),)
TOO_GOOD = RailValidity((make_verdict(status="fail"),), "0.2", wheels_lock=False, decides=False)
NAMELESS = make_verdict(status="fail", layer="requirement", value=600.0, margin=-110.0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        pytest.param({"outcome": "skipped"}, "is not judged", id="skipped"),
        pytest.param(
            {"outcome": "fail", "criteria": (NAMELESS,), "expect": expectation_of("fail"), "strict": True},
            "meets an expectation that --strict refuses",
            id="strict-and-nameless",
        ),
        pytest.param(
            {"criteria": (make_verdict(sensitivity=TURNS),), "strict": True},
            "has a verdict that is not settled",
            id="unsettled",
        ),
    ],
)
def test_what_is_not_as_expected_is_called_what_it_is(changes, said):
    [group] = run_summary(make_content(make_result(**changes))).groups
    assert group.heading.endswith(said)


def test_cases_that_differ_are_grouped_by_quantity_and_direction_and_the_furthest_out_speaks():
    cases = [make_result(id=f"s[f={k}]", scenario="s.yaml") for k in range(4)]
    distances = {"s[f=0]": 401.0, "s[f=1]": 600.0, "s[f=2]": 300.0}
    differences = {
        name: [Difference(name, "braking_distance_m", 400.0, value, False, "m", abs(value - 400.0), 0.5)]
        for name, value in distances.items()
    }
    lost = Difference("lost", "outcome", "pass", "none", within=False)
    baseline = BaselineComparison(
        "kept", "00", differences={**differences, "lost": [lost]}, missing={"lost": "s.yaml"}
    )
    summary = run_summary(make_content(*cases, baseline=baseline))
    longer, shorter, missing = (group.block for group in summary.groups)
    assert longer.heading.startswith("2 cases differ from the baseline")
    assert longer.lines[0] == "worst case: s[f=1]"
    assert "is 600 m" in longer.lines[1]
    assert shorter.heading == "s[f=2] differs from the baseline"
    assert missing.heading == "lost is in the baseline and missing here"
    assert summary.headline == (
        "3 of 4 cases differ from the baseline: s[f=0], s[f=1], s[f=2];"
        " 1 case is in the baseline and missing here: lost"
    )


@pytest.mark.parametrize("command", [("uictest", "run"), ("uictest", "evaluate")])
def test_the_worst_case_of_several_scenarios_is_named_with_and_without_a_command(command):
    content = make_content(
        *(
            make_result(id=name, scenario="s.yaml", outcome="fail", criteria=verdicts)
            for name, verdicts in {
                "x[f=1]": (locked(9.0), NAMELESS),
                "y[f=1]": (locked(3.0), replace(NAMELESS, value=900.0, margin=-410.0)),
            }.items()
        ),
        manifest=RunManifest(command=command),
    )
    [group] = run_summary(content).groups
    lines = [*group.block.lines, group.command]
    assert lines[0] == "locked-wheels in both, worst 9 s (limit 1 s)"
    assert lines[1].endswith(", y[f=1]")
    assert sum("x[f=1]" in line for line in lines) == 1


def test_a_series_some_of_whose_stops_failed_to_run_says_so_first():
    failed = replace(MISSED, outcome="error", reason="2 of 12 stops failed to run")
    [group] = run_summary(make_content(series=[failed])).groups
    assert group.sentences[0] == "2 of 12 stops failed to run"
    assert len(group.sentences) > 1


@pytest.mark.parametrize(("status", "causes"), [("pass", 0), ("fail", 1)])
def test_a_rail_is_a_cause_only_where_it_is_no_test(status, causes):
    rail = RailValidity(
        (make_verdict(layer="validity", status=status),), "0.08", wheels_lock=True, decides=False
    )
    result = case("0.06", "60 %", "fail", locked(9.0), rail=rail)
    assert len(run_summary(make_content(result)).groups[0].causes) == causes
    assert any("with the WSP bypassed" in sentence for sentence in explanation(result))


@pytest.mark.parametrize("there", [True, False])
def test_a_command_that_tries_the_controller_is_shown_where_its_file_is_there(there, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if there:
        (tmp_path / "acme.yaml").touch()
    library = Parameter("controller.library", "wsp.so", "", "wsp.so", "user")
    part = EffectivePart("controller", "controller", "acme", None, (library,))
    faulty = make_content(
        case("0.06", "60 %", "fail", locked(9.0), parts={"controller": part}, rail=TOO_GOOD),
        manifest=RunManifest(inputs={".../acme.yaml": "00"}),
    )
    [group] = run_summary(faulty).groups
    assert group.check == ("uictest controller check ./acme.yaml" if there else "")
    tried = f"try the controller by itself: {group.check}"
    assert (tried in group.block.lines) is there


def test_close_calls_are_one_line_for_each_criterion():
    lasting = {"60 %": 0.99, "80 %": 0.95, "100 %": 0.96}
    close = [case("0.06", command, "pass", locked(value)) for command, value in lasting.items()]
    [group] = run_summary(make_content(*close)).close
    assert str(group) == (
        "slip[friction=0.06,command=60]: locked-wheels 0.99 s (limit 1 s), 1 % to spare, and 2 more cases"
    )
    many = tuple(locked(0.99, id=f"criterion-{n}") for n in range(MOST_CLOSE + 1))
    sentences = close_lines(run_summary(make_content(make_result(criteria=many)))).sentences
    assert sentences[MOST_CLOSE:] == ["1 more criterion in criteria.csv"]


def test_what_the_recording_shows_stands_as_the_cause():
    recording = make_recording()
    reference = np.where(recording["time"] > 6.0, 1.25, recording["speed"])  # it follows the wheels down
    channels = recording.channels | {"reference_speed": reference}
    failed = case("0.06", "60 %", "fail", locked(9.0))
    trace = trace_of(
        type(recording)(channels, recording.units | {"reference_speed": "m/s"}, recording.metadata)
    )
    [group] = run_summary(make_content(failed, traces={failed.id: trace})).groups
    [cause] = group.causes
    assert "wrong by more than 15 % from 6.01 s on" in cause
    assert "4.5 km/h while the train runs at 98.4 km/h" in cause
    # It is no cause beside one of the rail, nor that of the other stops of a repeated case.
    for other in (replace(failed, rail=TOO_GOOD), replace(failed, repeats=Repeats("all", ()))):
        assert case_causes(other, trace) == []


def test_text_keeps_to_its_width_and_ends_with_what_failed():
    cases = nine({("0.06", "60 %"): ("fail", locked(3.0)), ("0.10", "60 %"): ("invalid", no_slide(6.0))})
    lines = list(run_lines(make_content(*cases), 100))
    assert max(map(len, lines)) <= 100
    table_end = max(index for index, line in enumerate(lines) if line.startswith("slip[") and "pass" in line)
    commands = [index for index, line in enumerate(lines) if line.startswith("  uictest run ")]
    assert len(commands) == 2
    assert min(commands) > table_end
    [last] = last_lines(make_content(*cases), " in 1.0 s", 200)
    assert last.startswith("FAILED: 1 of 9 cases failed: slip (locked-wheels); 1 is not a valid test")


def test_hostile_names_are_spelled_out():
    failed = case("0.06", "60 %", "fail", locked(3.0), id=f"slip{HOSTILE}", parameters={HOSTILE: HOSTILE})
    other = case("0.08", "60 %", parameters={HOSTILE: "1"})
    for line in run_lines(make_content(failed, other), 100):
        assert line.isprintable()


def test_a_case_and_a_series_of_one_id_are_told_apart():
    failed = case("0.06", "60 %", "fail", locked(3.0), id=MISSED.id)
    headline = run_summary(make_content(failed, series=[MISSED])).headline
    assert headline.startswith(f"1 of 1 case failed: {MISSED.id} (locked-wheels); 1 of 1 series ")


def test_a_stop_that_fails_before_it_ends_says_that_it_did_not_end():
    endless = make_verdict(
        id="standstill",
        layer="requirement",
        measure="standstill",
        status="inconclusive",
        reason="no standstill",
    )
    [group] = run_summary(make_content(case("0.06", "60 %", "fail", locked(9.0), endless))).groups
    assert list(group.causes) == ["no standstill"]


def test_a_run_that_ended_early_has_passed_nowhere():
    content = make_content(make_result(), complete=False)
    [last] = last_lines(content, "; interrupted; 3 not run", 200)
    assert last == "INCOMPLETE: 1 case: 1 pass; interrupted; 3 not run"
    assert '<h1 class="tally-incomplete">' in page_html(content)
    published = publication_of_run(content)
    assert 'errors="1"' in published.junit()
    assert "Incomplete" in published.markdown()
    failed = make_content(make_result(), case("0.06", "60 %", "fail", locked(3.0)), complete=False)
    assert 'errors="1"' not in publication_of_run(failed).junit()
