def test_each_row_is_printed_as_soon_as_its_sweep_has_run(monkeypatch, capsys):
    import growth

    printed = []

    def timed_sweep(cases, jobs):
        printed.append(len(capsys.readouterr().out.splitlines()))
        return growth.Run(cases, jobs, 10.0 / jobs, 10.0, 0.3)

    monkeypatch.setattr(growth, "timed_sweep", timed_sweep)
    runs = growth.table([100, 1000], [2, 1])
    assert printed == [1, 1, 1, 1]  # the heading, then the row of the sweep before
    assert [(run.cases, run.jobs) for run in runs] == [(100, 1), (100, 2), (1000, 1), (1000, 2)]
    assert capsys.readouterr().out.split()[-1] == "2.00"
