"""Figures of the studies. The functions draw into a figure; only writing one imports matplotlib."""
