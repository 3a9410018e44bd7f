def test_the_reduced_rig_reads_the_records_of_the_rig():
    from reduced_model import integrated_seconds
    from stops import slide_test

    assert integrated_seconds(slide_test(), 0.05) == 0.05
