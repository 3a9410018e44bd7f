import base64
import hashlib
import zlib

import pytest

from uictest.report.page import rendering as module
from uictest.report.page.rendering import packed_script, plotting_script


@pytest.fixture
def place(cache):
    plotting_script.cache_clear()
    yield cache
    plotting_script.cache_clear()


def test_the_script_is_packed_once_and_kept(place, monkeypatch):
    found = packed_script("draw();\n")
    assert zlib.decompress(base64.b64decode(found.packed)) == b"draw();\n"
    assert base64.b64decode(found.digest) == hashlib.sha256(b"draw();\n").digest()
    first = plotting_script()
    assert len(list(place.iterdir())) == 1
    plotting_script.cache_clear()
    monkeypatch.setattr(module, "packed_script", lambda script: pytest.fail("packed again"))
    assert plotting_script() == first


def test_another_version_of_the_script_is_packed_anew(place, monkeypatch):
    for version in ("draw();", "drawn();"):
        source = place / "plotly.min.js"
        source.write_text(version)
        monkeypatch.setattr(module, "_source", lambda found=source: found)
        plotting_script.cache_clear()
        assert plotting_script() == packed_script(version)


def test_a_damaged_script_is_packed_anew(place):
    first = plotting_script()
    (kept,) = place.iterdir()
    kept.write_bytes(kept.read_bytes()[:-100])
    plotting_script.cache_clear()
    assert plotting_script() == first


def test_without_plotly_the_reason_is_named(place, monkeypatch):
    monkeypatch.setattr(module, "find_spec", lambda name: None)
    with pytest.raises(ModuleNotFoundError, match="plotly is not installed"):
        plotting_script()
