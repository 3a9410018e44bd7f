"""The experiments of the paper and our own about its rig; each compares its values with the paper's."""

import os

# As in the program: a fit that one thread computes has the same bits on every machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
