"""Published numbers of others beside those of the rig: `python -m validation` writes pages and table."""

import os

# As in the program: what one thread computes has the same bits on every machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
