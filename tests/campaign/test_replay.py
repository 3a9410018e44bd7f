from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

import uictest.rig
from uictest.running.campaign import replay

MakeCase = Callable[..., Any]


def test_cases_are_simulated_again_with_a_recording_in_their_order(
    make_case: MakeCase, monkeypatch: pytest.MonkeyPatch
) -> None:
    def simulate(case: Any, record_every: float) -> Any:
        return SimpleNamespace(recording=f"{case.id} every {record_every} s")

    monkeypatch.setattr(uictest.rig, "simulate", simulate)
    cases = [make_case(name) for name in "abcdefgh"]
    found = [(case.id, recording) for case, recording in replay(cases, every=0.02, jobs=3)]
    assert found == [(name, f"{name} every 0.02 s") for name in "abcdefgh"]


def test_nothing_to_replay_is_no_error() -> None:
    assert list(replay([], every=0.02, jobs=1)) == []
