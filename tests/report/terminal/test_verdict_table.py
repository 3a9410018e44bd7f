import io

import pytest
from rich.console import Console

from uictest.report import RunContent
from uictest.report.terminal.verdict_table import explanation_text, verdict_table

from ..builders import make_result, make_verdict


def _table(*results, width=120):
    return verdict_table(results, RunContent("run", results, {}).word, width)[0]


def _explanation(result, *, every_criterion=False):
    return explanation_text(RunContent("run", [result], {}), result, every_criterion=every_criterion)


def _rendered(renderable, width=120, *, terminal=False):
    buffer = io.StringIO()
    colours = "truecolor" if terminal else None
    Console(file=buffer, width=width, force_terminal=terminal, color_system=colours).print(renderable)
    return buffer.getvalue()


def test_a_row_holds_verdict_and_figures():
    row = _rendered(_table(make_result(), width=140), width=140).splitlines()[-1].split()
    figures = ["465.2", "27.5", "1.20", "-", "-", "8", "0.0", "0.0", "4"]
    assert row == ["dry-120[command=90]", "pass", "yes", "-", *figures]


def test_a_long_id_is_folded_and_not_cut():
    case_id = "slip-" + "0123456789" * 10
    shown = _rendered(_table(make_result(id=case_id), width=90), width=90)
    first_column = "".join(line.split(" ", 1)[0] for line in shown.splitlines()[1:])
    assert first_column == case_id


def test_markup_and_terminal_codes_in_a_name_are_shown_as_text():
    result = make_result(id="[red]x[/red]\x1b[2J", outcome="error", reason="[/]", criteria=())
    for renderable in (_table(result), _explanation(result)):
        shown = _rendered(renderable, terminal=True)
        assert r"[red]x[/red]\x1b[2J" in shown
        assert "\x1b[2J" not in shown


def test_the_explanation_names_expectation_and_deciding_criterion_or_every_one_when_asked():
    limit = {"layer": "requirement", "value": 3.0, "unit": "s", "lower": None, "upper": 1.0, "margin": None}
    broken = make_verdict(id="locked", status="fail", reason="locked for 3 s", **limit)
    shown = _rendered(_explanation(make_result(outcome="fail", criteria=(make_verdict(), broken))))
    assert shown.splitlines() == [
        "fail dry-120[command=90]",
        "  fail: locked 3 s, upper limit 1 s. Expected: pass",
        "  test validity: valid; requirements: missed (locked)",
        "  locked (requirement) fail: locked for 3 s",
    ]
    assert "braking-distance (validity) pass" in _rendered(_explanation(make_result(), every_criterion=True))


@pytest.mark.parametrize("width", [40, 60, 80, 100, 120, 200])
def test_figures_give_way_to_the_names_of_cases(width):
    ids = ["dry-120", "slide-80[compensation=hysteresis]", "wet-80-friction[friction=0.10]"]
    results = [make_result(id=case_id) for case_id in ids]
    table, not_shown = verdict_table(results, RunContent("run", results, {}).word, width)
    lines = _rendered(table, width).splitlines()
    assert max(map(len, lines)) <= width
    assert "…" not in "".join(lines)
    names = "".join(line[: line.index("verdict")] if "verdict" in line else _name(line) for line in lines)
    assert [case_id for case_id in ids if case_id not in names] == []
    figures = {"distance", "time", "adhesion", "slide", "sliding", "locked", "vents"}
    shown = {name for name in figures if name in lines[0]}
    assert {name for name in figures if name in not_shown} == figures - shown
    assert ("summary.csv" in not_shown) == (shown < figures)


def _name(line):
    return line.split("  ")[0].strip()


def test_a_column_that_a_missed_criterion_rests_on_is_left_out_last():
    locked = make_verdict(measure="locked_time", status="fail", unit="s", value=9.0)
    missed, kept = make_result(outcome="fail", criteria=(locked,)), make_result()
    shown, not_shown = (verdict_table([missed], RunContent("run", [missed], {}).word, 50)[k] for k in (0, 1))
    assert "locked" in _rendered(shown, 50).splitlines()[0]
    assert "distance" in not_shown
    table, not_shown = verdict_table([kept], RunContent("run", [kept], {}).word, 50)
    assert "locked" not in _rendered(table, 50).splitlines()[0]
    assert "locked" in not_shown


def test_a_missed_criterion_of_a_measure_that_is_no_column_has_a_column_of_its_own():
    locked = make_verdict(id="locked-wheels", measure="longest_lock", status="fail", unit="s", value=109.66)
    missed, kept = make_result(id="a", outcome="fail", criteria=(locked,)), make_result(id="b", criteria=())
    table, _ = verdict_table([missed, kept], RunContent("run", [missed, kept], {}).word, 50)
    lines = _rendered(table, 50).splitlines()
    assert lines[0].split()[-1] == "locked-wheels"
    assert [line.split()[-1] for line in lines[1:]] == ["s", "109.7", "-"]
