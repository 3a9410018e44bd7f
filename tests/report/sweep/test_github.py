from uictest.report.sweep.sweep_sentences import MOST_ANNOTATED, sweep_annotations

from ..builders import HOSTILE, make_result


def _annotations(content):
    return sweep_annotations(content.result, content.manifest["file"])


def test_cases_that_are_not_met_are_annotated_and_the_sweep_is_counted(make_sweep):
    missed = make_result(id="b[x]", outcome="fail", criteria=(), reason="locked")
    tally = "4 cases: 3 pass, 1 fail; 1 not as expected"
    assert list(_annotations(make_sweep((missed, make_result()), "pads"))) == [
        "::error file=scenarios/pads.sweep.yaml,title=fail b[x]::fail. Expected: pass; locked",
        "::error file=scenarios/pads.sweep.yaml,title=invalid lost[pads]::got invalid: pads",
        f"::notice file=scenarios/pads.sweep.yaml,title=uictest sweep pads::{tally}",
    ]


def test_there_are_no_more_annotations_than_github_shows(make_sweep):
    missed = tuple(make_result(id=f"case-{k}", outcome="fail") for k in range(12))
    lines = list(_annotations(make_sweep(missed)))
    assert sum(line.startswith("::error ") for line in lines) == MOST_ANNOTATED
    assert "title=fail case-0::" in lines[0]


def test_a_hostile_name_cannot_start_a_command_of_its_own(make_sweep):
    bad = make_result(id=HOSTILE, parameters={HOSTILE: HOSTILE}, outcome="error", reason=HOSTILE)
    for line in _annotations(make_sweep((bad,), HOSTILE)):
        assert line.startswith(("::error file=", "::notice file="))
        assert not set("\n\r\x00\x1b\u202e") & set(line)
        properties = line.split("::")[1]
        assert properties.count(",") == 1
