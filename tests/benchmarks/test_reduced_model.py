def test_the_reduced_rig_reads_the_records_of_the_rig() -> None:
    from reduced_model import integrated_seconds  # type: ignore[import-not-found]
    from stops import shipped  # type: ignore[import-not-found]

    assert integrated_seconds(next(iter(shipped().values())), 0.05) == 0.05
