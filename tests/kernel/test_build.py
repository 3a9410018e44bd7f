"""What is compiled again, and what is not made a library."""

import pytest

from kernel import build
from uictest.rig.kernel import library

C = ("-x", "c", "-O1")


def test_a_file_is_compiled_again_when_it_or_a_header_below_its_folder_has_changed(tmp_path, monkeypatch):
    """Once the headers of FMI were not looked at: FMUs had the functions of before."""
    monkeypatch.setattr(build, "OBJECTS", tmp_path / "objects")
    source, header = tmp_path / "source" / "number.c", tmp_path / "source" / "below" / "number.h"
    header.parent.mkdir(parents=True)
    compiled = []
    for number in ("1", "2", "1"):
        header.write_text(f"#define NUMBER {number}\n", "utf-8")
        source.write_text('#include "below/number.h"\nint number(void) { return NUMBER; }\n', "utf-8")
        compiled.append(build.compile_file(source, build.TARGETS[build.host()], C))
    first, other, again = compiled
    assert first == again != other
    assert first.read_bytes() != other.read_bytes()


def test_what_changes_while_it_is_compiled_becomes_no_library(tmp_path, monkeypatch):
    """Else the digest of the new sources would name code of the old."""
    (tmp_path / "build.py").touch()
    monkeypatch.setattr(library, "BUILDER", tmp_path)
    with pytest.raises(build.BuildError, match="were changed while they were compiled; build again"):
        build.put_library(build.TARGETS[build.host()], [], tmp_path / "package", "rig")
    assert not (tmp_path / "package").exists()
