from uictest.recorded.field_data import recorded_description, stated_case
from uictest.report import subjects_form
from uictest.report.run_folder import read_subjects


def test_a_recorded_stop_is_headed_by_its_file_and_by_what_was_read_and_derived(case, channels, prepared):
    names = (
        "speed",
        "wheel_speed_1",
        "wheel_speed_2",
        "wheel_speed_3",
        "wheel_speed_4",
        "cylinder_pressure_1",
    )
    subject = recorded_description(case, prepared({name: channels[name] for name in names}))
    assert subject.title == "Recorded stop"
    assert subject.recorded["file"] == "stop"
    assert subject.recorded["channels read"] == "time, speed, wheel_speed_1 .. 4, cylinder_pressure_1"
    assert subject.recorded["distance"] == "integrated from speed"
    assert subject.recorded["sampling"] == "speed every 10 ms"
    assert subject.recorded["trigger"] == "at 0 s, stated by the file"
    assert "distance" not in recorded_description(case, prepared(channels)).recorded
    assert read_subjects({"subjects": subjects_form({"a": subject})}) == {"a": subject}


def test_nothing_of_a_simulated_rig_is_said_of_a_recorded_stop(case, channels, prepared):
    subject = recorded_description(case, prepared(channels))
    text = str(subjects_form({"a": subject}))
    for of_the_rig in ("intercity-180", "one-caliper", "threshold", "compensation", "0.08", "ep-disc"):
        assert of_the_rig not in text


def test_a_condition_that_nobody_stated_is_marked_as_assumed(channels, prepared):
    statements = ["rail.condition=wet", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop"]
    stop = prepared(channels)
    settings = recorded_description(stated_case("run", 40 / 3.6, statements), stop).settings
    assert settings["initial speed"] == "40 km/h, recorded"
    assert settings["brake command"] == "100 % (assumed: not stated)"
    assert settings["gradient"] == "0 permille (assumed: not stated)"
    assert (settings["rail"], settings["brake position"], settings["WSP"]) == ("wet", "R", "active")
    stated = stated_case("run", 40 / 3.6, [*statements, "brake.command=80 %"])
    assert recorded_description(stated, stop).settings["brake command"] == "80 %"


def test_a_record_that_cannot_be_used_has_its_file_all_the_same(case):
    assert dict(recorded_description(case, None).recorded) == {"file": "stop"}
