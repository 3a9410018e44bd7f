from pathlib import Path


def test_every_part_is_listed_with_its_title_and_shows_marks_and_sources(call):
    lines = call("library", "list").out.splitlines()
    listed = {line.split()[0] for line in lines}
    assert {"vehicles/intercity-180", "criteria/uic-541-05-appendix-b"} <= listed
    assert {"channel_maps/common-names", "benches/triangular"} <= listed
    assert all(len(line.split(maxsplit=1)) == 2 for line in lines)
    for line in call("library", "list").out.splitlines():
        answer = call("library", "show", line.split()[0], code=0)
        if line.startswith(("channel_maps/", "pads/constant")):
            continue  # without numbers
        numbers, *rest = answer.out.split("\n\n")
        for row in numbers.splitlines()[1:]:
            assert {"stated", "published", "identified", "chosen", "default"} & set(row.split()), row
        title, *sources = rest[0].splitlines()
        assert title == "sources"
        assert len({source.split()[0] for source in sources}) == len(sources)


def test_parts_are_shown_with_provenance_known_names_and_numbers_as_written(call):
    shown = call("library", "show", "compensations/six-inch").out.split("\n\n")[-1]
    assert shown.startswith("provenance\n")
    assert "uictest identify cylinder" in shown
    lines = call("library", "show", "channel_maps/common-names").out.splitlines()
    assert any(line.startswith("speed ") and "vZug" in line for line in lines)
    lines = call("library", "show", "vehicles/manchester-benchmark").out.splitlines()
    (mass,) = (line for line in lines if line.startswith("body.mass"))
    assert mass.split()[1:4] == ["32000", "kg", "published"]


def test_a_users_part_shows_marks_sources_and_what_it_changes(call):
    Path("mine.yaml").write_text(
        "schema: uictest/controller/1\nname: mine\ntitle: Ours\nextends: threshold\nslip_threshold: 3 km/h\n"
        "sources: {bench: {mark: published, text: Our bench test of 2024}}\n"
        "hold_limit: {value: 3 s, source: bench}\n"
    )
    answer = call("library", "show", "mine.yaml")
    lines = [" ".join(line.split()) for line in answer.out.splitlines()]
    assert answer.code == 0
    assert lines[:2] == ["mine.yaml: Ours", "based on threshold"]
    assert "slip_threshold 3 km/h user (threshold: 0.9993 m/s)" in lines
    assert "hold_limit 3 s published bench (threshold: 2 s)" in lines
    assert "vent_watchdog 5 s chosen" in lines
    assert "bench Our bench test of 2024" in lines
