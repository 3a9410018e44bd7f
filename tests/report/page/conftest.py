import pytest


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache of its own; what earlier programs left in the temporary folder is not seen."""
    (tmp_path / "file").write_text("not a folder")
    (tmp_path / "cache").mkdir()
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    return tmp_path / "cache"
