import pytest


@pytest.fixture
def root(tmp_path, monkeypatch):
    """The user's cache, not made yet; the temporary folder can take none."""
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    return tmp_path / "cache"
