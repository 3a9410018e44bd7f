"""What every test of the package shares."""

import os

from hypothesis import settings

# How long an example takes says nothing about it on a machine that others use as well.
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("search", deadline=None, max_examples=1000)
# The suite tries the same examples everywhere, so that no run fails by chance; HYPOTHESIS_PROFILE=search
# tries others.
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))
