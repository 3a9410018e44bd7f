import pytest

from uictest.core.envelope import MANIFEST
from uictest.report.manifest import RunManifest, manifest_digest, manifest_form, read_manifest, run_manifest


def test_it_names_versions_of_what_decides_the_numbers_and_no_folder_of_the_machine(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    command = f"run {tmp_path}/scenarios -k dry -o /elsewhere/out --output=/elsewhere/out"
    content = run_manifest(command.split(), 7, {str(tmp_path / "a.yaml"): "00", "library:x": "11"}, cases=3)
    assert " ".join(content.command) == "uictest run scenarios -k dry -o .../out --output=.../out"
    assert content.inputs == {"a.yaml": "00", "library:x": "11"}
    assert (content.seed, content.cases) == (7, 3)
    assert {"uictest", "python", "numpy", "pydantic"} <= content.versions.keys()
    assert all(content.versions.values())


def test_the_digest_is_short_and_follows_the_content():
    here, there = {"a": "1", "b": "2"}, {"b": "2", "a": "1"}
    assert manifest_digest(RunManifest(inputs=here)) == manifest_digest(RunManifest(inputs=there))
    assert manifest_digest(RunManifest(seed=1)) != manifest_digest(RunManifest(seed=2))
    assert len(manifest_digest(RunManifest())) == 8


def test_it_is_read_back_and_what_is_none_is_rejected():
    manifest = RunManifest(command=("uictest", "run"), seed=3, inputs={"a.yaml": "00"})
    assert read_manifest({"manifest": manifest_form(manifest)}) == manifest
    with pytest.raises(ValueError, match=r"manifest: expected schema .* found no schema"):
        read_manifest({})
    with pytest.raises(ValueError, match=r"manifest\.seed"):
        read_manifest({"manifest": manifest_form(manifest) | {"seed": "three"}})


def test_one_of_another_schema_or_kind_is_not_read():
    for head, found in [
        (
            {"schema": "uictest/manifest/1"},
            "found schema 'uictest/manifest/1', written by uictest 0.2",
        ),
        ({"schema": MANIFEST, "kind": "sweep"}, "found schema 'uictest/manifest/2', kind 'sweep'"),
        ({"schema": "uictest/manifest/9", "kind": "run"}, "found schema 'uictest/manifest/9', kind 'run'"),
        ({}, "found no schema"),
    ]:
        with pytest.raises(ValueError, match=f"manifest: expected schema '{MANIFEST}', kind 'run', {found}"):
            read_manifest({"manifest": {**head, "seed": 3}})
