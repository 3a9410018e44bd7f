"""The manifest: the inputs of a run, the same on every machine."""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cache
from importlib import metadata
from pathlib import Path, PurePath
from typing import Any, ClassVar, Final

from pydantic import ConfigDict, TypeAdapter

from uictest.core import envelope
from uictest.judging import evaluation
from uictest.report.part_wording import part_sentence

CASES_IN_PYTHON: Final = "(cases loaded in Python)"
"""In a command, behind `run`: a program gave the cases, and no files of their own name them."""
_PACKAGES = ("uictest", "numpy", "pydantic", "pyyaml")


@dataclass(frozen=True, slots=True)
class RunManifest:
    """Where the results of a run come from.

    Args:
        schema: version of this form.
        kind: of the results: `run`.
        command: the program and its arguments as typed, without the folders of the machine.
        seed: the seed given for all cases; None where each scenario has its own.
        cases: how many cases were selected.
        versions: program or package -> version.
        inputs: file that was read -> its SHA-256.
        parts: id of a part -> the part in words.

    """

    __pydantic_config__: ClassVar = ConfigDict(defer_build=True)

    schema: str = envelope.MANIFEST
    kind: str = "run"
    command: tuple[str, ...] = ("uictest",)
    seed: int | None = None
    cases: int = 0
    versions: Mapping[str, str] = field(default_factory=dict)
    inputs: Mapping[str, str] = field(default_factory=dict)
    parts: Mapping[str, str] = field(default_factory=dict)


_MANIFEST: Final = TypeAdapter(RunManifest)


def manifest_form(manifest: RunManifest) -> dict[str, Any]:
    """Return the JSON form of a manifest."""
    # pydantic does not keep a name of `inputs` that is no UTF-8.
    return asdict(manifest)


def read_manifest(content: Mapping[str, Any]) -> RunManifest:
    """Return the manifest in the results of a run.

    Raises ValueError where there is none, a field holds something else, or it is of another schema or kind.
    """
    own = content.get("manifest")
    try:
        envelope.require(own if isinstance(own, Mapping) else {}, envelope.MANIFEST, "run")
    except ValueError as error:
        raise ValueError(f"manifest: {error}") from error
    return evaluation.from_json_form(_MANIFEST, own, place="manifest")


def run_manifest(
    command: Sequence[str],
    seed: int | None,
    inputs: Mapping[str, str],
    cases: int,
    parts: Iterable[Mapping[str, evaluation.EffectivePart]] = (),
) -> RunManifest:
    """Return the manifest of a run.

    Args:
        command: the arguments as typed; absolute paths are shown without the machine's folders.
        seed: the seed given for all cases, None where each scenario has its own.
        inputs: every file read -> its SHA-256.
        cases: how many cases were selected.
        parts: of each case, by role.
    """
    return RunManifest(
        command=("uictest", *(without_machine(word) for word in command)),
        seed=seed,
        cases=cases,
        versions=dict(_versions()),
        inputs={without_machine(name): digest for name, digest in sorted(inputs.items())},
        parts=named_parts(parts),
    )


def named_parts(cases: Iterable[Mapping[str, evaluation.EffectivePart]]) -> dict[str, str]:
    """Return every distinct part of some cases in words, by id; the sections of a scenario are no parts."""
    table = sorted(evaluation.parts_table(cases).items())
    return {part_id: part_sentence(part) for part_id, part in table if part.name}


def manifest_digest(manifest: RunManifest) -> str:
    """Return the first eight hexadecimal digits of the SHA-256 of a manifest."""
    text = json.dumps(manifest_form(manifest), sort_keys=True)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:8]


def without_machine(word: str) -> str:
    """Return a path, or an option with one, without the folders of this machine."""
    option, equals, value = word.partition("=") if word.startswith("--") else ("", "", word)
    path = PurePath(value)
    if not path.is_absolute():
        return word
    shown = path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else PurePath("...", path.name)
    return f"{option}{equals}{shown.as_posix()}"


@cache
def _versions() -> Mapping[str, str]:
    return {"python": platform.python_version()} | {name: metadata.version(name) for name in _PACKAGES}
