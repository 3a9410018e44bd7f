from __future__ import annotations

from pathlib import Path

import pytest

from uictest.report.manifest import RunManifest, manifest_digest, manifest_form, read_manifest, run_manifest


def test_folders_of_the_machine_are_not_part_of_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    command = [
        "run",
        str(tmp_path / "scenarios"),
        "-k",
        "dry",
        "-o",
        "/elsewhere/out",
        "--output=/elsewhere/out",
    ]
    content = run_manifest(command, 7, {str(tmp_path / "a.yaml"): "00", "library:x": "11"}, cases=3)
    assert content.command == (
        "uictest",
        "run",
        "scenarios",
        "-k",
        "dry",
        "-o",
        ".../out",
        "--output=.../out",
    )
    assert content.inputs == {"a.yaml": "00", "library:x": "11"}
    assert (content.seed, content.cases) == (7, 3)


def test_versions_of_what_decides_the_numbers_are_named() -> None:
    versions = run_manifest([], None, {}, cases=0).versions
    assert {"uictest", "python", "numpy", "numba"} <= versions.keys()
    assert all(versions.values())


def test_the_digest_is_short_and_follows_the_content() -> None:
    here, there = {"a": "1", "b": "2"}, {"b": "2", "a": "1"}
    assert manifest_digest(RunManifest(inputs=here)) == manifest_digest(RunManifest(inputs=there))
    assert manifest_digest(RunManifest(seed=1)) != manifest_digest(RunManifest(seed=2))
    assert len(manifest_digest(RunManifest())) == 8


def test_it_is_read_back_and_what_is_none_is_rejected() -> None:
    manifest = RunManifest(command=("uictest", "run"), seed=3, inputs={"a.yaml": "00"})
    assert read_manifest({"manifest": manifest_form(manifest)}) == manifest
    assert read_manifest({"manifest": {"seed": 3}}) == RunManifest(seed=3)
    with pytest.raises(ValueError, match="seed"):
        read_manifest({"manifest": {"seed": "three"}})
