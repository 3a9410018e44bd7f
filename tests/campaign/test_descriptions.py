import pytest

from uictest.plans.scenario import load
from uictest.report import subjects_form
from uictest.report.run_folder import read_subjects
from uictest.running.campaign import descriptions_of

_TEXT = "schema: uictest/scenario/1\nname: stop\ntitle: A stop\ntags: [a, b]\ninitial_speed: 80 km/h\n"


def _subject(tmp_path, text=""):
    path = tmp_path / "stop.yaml"
    path.write_text(_TEXT + text)
    return descriptions_of(load([path]))["stop"]


def test_a_subject_is_in_the_users_words(tmp_path):
    subject = _subject(tmp_path, "rail: {condition: wet, friction: 0.10}\n")
    assert (subject.title, subject.tags) == ("A stop", ("a", "b"))
    assert subject.settings["initial speed"] == "80 km/h"
    assert subject.settings["rail"] == "wet, friction 0.10, gradient 0 permille"
    assert read_subjects({"subjects": subjects_form({"a": subject})}) == {"a": subject}


@pytest.mark.parametrize(
    ("friction", "shown"),
    [
        ("", "dry, friction 0.55, "),
        ("  friction: {points: [{position: 0 m, friction: 0.3}]}\n", "dry, friction along the track, "),
        (
            "  friction: 0.2\n  friction_over_time: {points: [{time: 0 s, factor: 1}]}\n",
            "dry, friction 0.2, changing with time, ",
        ),
    ],
)
def test_friction_is_a_number_a_course_or_the_condition_s_own(tmp_path, friction, shown):
    assert _subject(tmp_path, f"rail:\n  condition: dry\n{friction}").settings["rail"].startswith(shown)
