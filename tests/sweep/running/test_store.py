"""Parts on disk: whole or not there, and only those of the same inputs."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pytest

from uictest.sweep import ChangedInputsError, MissingChunksError, Store
from uictest.sweep.running.chunk import parquet_bytes

MANIFEST = {"schema": "x", "cases": 3, "inputs": {"a.yaml": "1", "b.yaml": "2"}, "program": "p"}


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """A store with two parts."""
    store = Store(tmp_path / "study")
    store.begin(MANIFEST, restart=False)
    for number in (0, 2):
        store.write(number, parquet_bytes(pa.table({"index": [number]})))
    return store


def part(store: Store, number: int) -> Path:
    return next((store.folder / "parts").glob(f"{number:06d}-*"))


def test_what_is_finished_is_found_again(store: Store) -> None:
    again = Store(store.folder)
    again.begin(MANIFEST, restart=False)
    assert again.finished() == ({0, 2}, [])
    assert [table.column("index").to_pylist() for table in again.tables([2, 0])] == [[2], [0]]


@pytest.mark.parametrize("damage", [lambda b: b[:-1], lambda b: b"", lambda b: bytes([b[0] ^ 1]) + b[1:]])
def test_a_damaged_part_is_found_and_removed(store: Store, damage) -> None:  # type: ignore[no-untyped-def]
    path = part(store, 2)
    path.write_bytes(damage(path.read_bytes()))
    assert store.finished() == ({0}, [path])
    assert not path.exists()


def test_changed_inputs_are_refused_by_name(store: Store) -> None:
    changed = {**MANIFEST, "inputs": {"a.yaml": "1", "b.yaml": "3"}, "program": "q"}
    with pytest.raises(ChangedInputsError, match=r"^inputs: b\.yaml; the program itself$"):
        store.begin(changed, restart=False)
    assert store.finished()[0] == {0, 2}
    store.begin(changed, restart=True)
    assert store.finished()[0] == set()
    assert store.manifest() == changed


def test_inputs_may_change_before_the_first_part(tmp_path: Path) -> None:
    store = Store(tmp_path / "study")
    store.begin(MANIFEST, restart=False)
    store.begin({**MANIFEST, "device": "cuda"}, restart=False)
    assert store.manifest() == {**MANIFEST, "device": "cuda"}


def test_parts_without_a_manifest_are_not_trusted(store: Store) -> None:
    (store.folder / "manifest.json").write_text("{")
    store.begin(MANIFEST, restart=False)
    assert store.finished()[0] == set()


def test_a_missing_part_is_told(store: Store) -> None:
    with pytest.raises(MissingChunksError, match="1 parts are not there: 1"):
        list(store.tables([0, 1]))


def test_shares_are_put_together_and_damaged_parts_left_behind(store: Store, tmp_path: Path) -> None:
    whole = Store(tmp_path / "whole")
    whole.begin(MANIFEST, restart=False)
    damaged = part(store, 0)
    damaged.write_bytes(b"")
    assert whole.take(store) == (1, [damaged])
    assert whole.finished() == ({2}, [])
    other = Store(tmp_path / "other")
    other.begin({**MANIFEST, "cases": 4}, restart=False)
    with pytest.raises(ChangedInputsError, match="cases: 3 in this sweep, 4 in the share"):
        whole.take(other)


def test_the_name_of_the_sweep_file_is_no_difference(store: Store, tmp_path: Path) -> None:
    elsewhere = Store(tmp_path / "elsewhere")
    elsewhere.begin({**MANIFEST, "file": "../study.sweep.yaml"}, restart=False)
    assert elsewhere.take(store) == (2, [])
    store.begin({**MANIFEST, "file": "study.sweep.yaml"}, restart=False)
    assert store.finished()[0] == {0, 2}


def test_what_interrupted_writers_left_is_tidied_away(store: Store) -> None:
    (store.folder / "parts" / ".partial-1.parquet").touch()
    store.tidy()
    assert len(list((store.folder / "parts").iterdir())) == 2
