from types import SimpleNamespace

import uictest.rig
from uictest.running.campaign import replay


def test_cases_are_simulated_again_with_a_recording_in_their_order(make_case, monkeypatch):
    def simulate(case, record_every):
        return SimpleNamespace(recording=f"{case.id} every {record_every} s")

    monkeypatch.setattr(uictest.rig, "simulate", simulate)
    cases = [make_case(name) for name in "abcdefgh"]
    found = [(case.id, recording) for case, recording in replay(cases, every=0.02, jobs=3)]
    assert found == [(name, f"{name} every 0.02 s") for name in "abcdefgh"]
    assert list(replay([], every=0.02, jobs=1)) == []
