"""Compute the stored numbers of `uictest selftest` anew and write them into the package.

    python scripts/selftest_reference.py

Run it after a change that is meant to change results, and for every release. The difference that git shows
is what users will see: say why in the changelog.
"""

from uictest import selftest
from uictest.core import files

files.write_to(selftest.REFERENCE, selftest.computed_reference())
print(f"{selftest.REFERENCE.name}: written")
