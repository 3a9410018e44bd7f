from __future__ import annotations

from typing import Any

import pytest


def test_each_row_is_printed_when_it_is_measured(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import growth  # type: ignore[import-not-found]

    printed: list[int] = []

    def measured(cases: int, jobs: int) -> Any:
        printed.append(len(capsys.readouterr().out.splitlines()))
        return growth.Run(cases, jobs, 10.0 / jobs, 0.3)

    monkeypatch.setattr(growth, "measured", measured)
    runs = growth.table([100, 1000], [2, 1])
    assert printed == [1, 1, 1, 1]  # the heading, then the row of the measurement before
    assert [(run.cases, run.jobs) for run in runs] == [(100, 1), (100, 2), (1000, 1), (1000, 2)]
    assert capsys.readouterr().out.split()[-1] == "2.00"
