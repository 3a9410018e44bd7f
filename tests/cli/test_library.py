from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

Call = Callable[..., Any]


def test_every_part_is_listed_with_its_title(call: Call) -> None:
    lines = call("library", "list").out.splitlines()
    listed = {line.split()[0] for line in lines}
    assert {"vehicles/intercity-180", "criteria/uic-541-05-appendix-b"} <= listed
    assert {"channel_maps/common-names", "benches/triangular"} <= listed
    assert all(len(line.split(maxsplit=1)) == 2 for line in lines)


def test_every_listed_part_shows_the_mark_of_every_number_and_each_source_once(call: Call) -> None:
    for line in call("library", "list").out.splitlines():
        answer = call("library", "show", line.split()[0])
        assert answer.code == 0
        numbers, *rest = answer.out.split("\n\n")
        if line.startswith("channel_maps/"):
            continue
        for row in numbers.splitlines()[1:]:
            assert {"stated", "published", "chosen", "default"} & set(row.split()), row
        title, *sources = rest[0].splitlines()
        assert title == "sources"
        assert len({source.split()[0] for source in sources}) == len(sources)


def test_a_compensation_shows_how_it_was_identified(call: Call) -> None:
    shown = call("library", "show", "compensations/six-inch").out.split("\n\n")[-1]
    assert shown.startswith("provenance\n")
    assert "uictest identify cylinder" in shown


def test_a_channel_map_shows_the_names_that_it_knows(call: Call) -> None:
    lines = call("library", "show", "channel_maps/common-names").out.splitlines()
    assert any(line.startswith("speed ") and "vZug" in line for line in lines)


def test_a_number_is_shown_as_written(call: Call) -> None:
    lines = call("library", "show", "vehicles/manchester-benchmark").out.splitlines()
    (mass,) = (line for line in lines if line.startswith("body.mass"))
    assert mass.split()[1:4] == ["32000", "kg", "published"]


@pytest.mark.parametrize(
    "reference", ["vehicles/intercity", "vehicle/intercity-180", "intercity-180", "\x1b[2J", ""]
)
def test_an_unknown_part_exits_4_and_says_what_there_is(call: Call, reference: str) -> None:
    answer = call("library", "show", reference)
    assert (answer.code, answer.out) == (4, "")
    assert "intercity-180" in answer.err or "vehicles/..." in answer.err
    assert "\x1b" not in answer.err
