"""What a message looks like."""

from pathlib import Path

from uictest.plans.scenario.yaml.diagnostics import (
    Document,
    Location,
    ScenarioErrors,
    diagnose,
    in_reading_order,
    nearest,
    quoted,
    suggestion,
    visible,
)


def place(text, line, column, display="a.yaml"):
    return Location(Document(display, Path(), text), line, column)


def test_a_message_shows_place_line_caret_and_hint():
    diagnostic = diagnose(place("x\nspeed: 120\n", 2, 8), "'120' has no unit", "speed", "write 120 km/h")
    assert str(diagnostic) == (
        "a.yaml:2:8: speed: '120' has no unit\n    2 | speed: 120\n      |        ^\n      = write 120 km/h"
    )


def test_the_caret_stays_below_what_it_points_at():
    for line, column in (("a\t\x1b[2J b: 1", 8), ("\u65e5\u672c b: 1", 4), ("x" * 500 + "b", 501)):
        excerpt, caret = diagnose(place(line, 1, column), "wrong").excerpt.split("\n")
        wide = sum(char > "\u2000" for char in excerpt)
        assert excerpt[len(caret) - 1 - wide] == "b"


def test_a_file_name_cannot_act_on_the_terminal():
    assert str(diagnose(place("", 1, 1, "\x1b[31m\u202e.yaml"), "wrong")).startswith(
        "\\x1b[31m\\u202e.yaml:1:1:"
    )


def test_the_same_error_is_told_once():
    diagnostic = diagnose(place("a", 1, 1), "wrong")
    assert ScenarioErrors([diagnostic, diagnostic]).diagnostics == (diagnostic,)


def test_reading_order_goes_down_each_file_in_turn():
    second, first = diagnose(place("a\nb", 2, 1), "x"), diagnose(place("a\nb", 1, 1), "y")
    other = diagnose(place("a", 1, 1, "b.yaml"), "z")
    assert in_reading_order([second, other, first]) == [first, second, other]


def test_escapes_name_the_character():
    assert visible("a\x07\u202eb\U000e0001") == "a\\x07\\u202eb\\U000e0001"
    assert quoted("x" * 100) == "'" + "x" * 57 + "...'"


def test_the_nearest_name_is_found_in_any_case_of_letters():
    assert nearest("Intercity-108", ["crh380a", "intercity-180"]) == "intercity-180"
    assert nearest("zzz", ["crh380a"]) is None
    assert suggestion("zzz", ["b", "a"]) == "accepted: a, b"
