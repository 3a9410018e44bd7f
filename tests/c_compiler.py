"""Libraries in C for tests; a test without a compiler is left out."""

import os
import shutil
import subprocess

import pytest

from uictest.controllers import HEADER


def c_compiler():
    """The C compiler: $CC, else gcc."""
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    if compiler is None:
        pytest.skip("no C compiler")
    return compiler


def build_library(library, *sources_and_options):
    """Compile sources into a shared library, with the header of controllers at hand."""
    options = ("-O2", "-ffp-contract=off", "-fPIC", "-shared", f"-I{HEADER.parent}")
    subprocess.run([c_compiler(), *options, "-o", library, *sources_and_options, "-lm"], check=True)
