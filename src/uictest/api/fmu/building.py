"""The archive of an FMU: libraries that are the same in all, and the files that say what this one is of."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

from uictest import rig
from uictest.api.fmu.binaries import SYSTEMS, library_of
from uictest.api.fmu.compiling import CannotBuildError
from uictest.api.fmu.description import FmiVersion, Model, model_description
from uictest.api.fmu.resource import FILE_NAME, Content

_NO_DATE: Final = (1980, 1, 1, 0, 0, 0)
"""The first that a ZIP archive can hold: the same content gives the same file on every day."""
_UNIX: Final = 3
"""The system that the archive says it was made on, wherever that is."""


def archive_of(
    model: Model,
    version: FmiVersion,
    content: Content,
    others: Mapping[str, bytes],
    systems: Iterable[str] = SYSTEMS,
) -> bytes:
    """Return the file of an FMU, on every machine the same.

    Args:
        model: what its description says; the token is added here.
        version: of FMI.
        content: what its library reads.
        others: other files of the archive, by path.
        systems: those that it is for.

    Raises CannotBuildError where this package has no library of FMUs.
    """
    try:
        libraries = {SYSTEMS[name]: library_of(name) for name in systems}
    except rig.KernelError as error:
        raise CannotBuildError(f"{error}") from error
    code = rig.source_digest()
    parts = (
        *sorted(path.name.encode() for path in libraries.values()),
        *others.values(),
        content.file(model, code),
    )
    model = replace(model, token=_token_of(repr((version, model)).encode(), *parts))
    names = {
        system: f"{system.folder_2 if version == 2 else system.folder}/{model.identifier}.{system.suffix}"
        for system in libraries
    }
    return _archive(
        {
            "modelDescription.xml": model_description(model, version),
            **{f"binaries/{names[each]}": path.read_bytes() for each, path in libraries.items()},
            FILE_NAME: content.file(model, code),
            **others,
        }
    )


def _token_of(*contents: bytes) -> str:
    """Return a GUID that only these contents have."""
    digits = hashlib.sha256(b"".join(contents)).hexdigest()
    return "{" + "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:32])) + "}"


def _archive(files: Mapping[str, bytes]) -> bytes:
    content = io.BytesIO()
    # Not compressed: machines have different compressors, which give different bytes.
    with zipfile.ZipFile(content, "w") as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, _NO_DATE)
            entry.create_system, entry.external_attr = _UNIX, 0o644 << 16
            archive.writestr(entry, data)
    return content.getvalue()
