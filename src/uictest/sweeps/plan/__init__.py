"""Plan a sweep: its file, its axes and draws, and the values of each case."""
