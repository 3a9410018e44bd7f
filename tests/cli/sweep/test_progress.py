"""What a sweep says of its progress where nobody watches a bar."""

from uictest.cli import progress


def test_a_line_now_and_then_with_rate_and_time_left(monkeypatch, capsys):
    moments = iter([100.0, 101.0, 102.0, 140.0])
    monkeypatch.setattr(progress, "monotonic", lambda: next(moments))
    monkeypatch.setattr(progress, "HEARTBEAT", 30.0)
    with progress.sweep_progress(1000, 100, quiet=False) as advance:
        for _ in range(3):
            advance(40)
    assert capsys.readouterr().err == "uictest: 220 of 1000 cases, 3 cases/s, 260 s left\n"


def test_quiet_says_nothing(monkeypatch, capsys):
    monkeypatch.setattr(progress, "HEARTBEAT", 0.0)
    with progress.sweep_progress(10, 0, quiet=True) as advance:
        advance(5)
    assert capsys.readouterr().err == ""
