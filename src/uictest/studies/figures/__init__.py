"""Figures of the studies. They draw into a figure that is given; only writing one needs matplotlib."""
