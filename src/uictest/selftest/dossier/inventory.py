"""What is installed: one digest of the package's files, and the packages that it needs with licences."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Final

_PACKAGE: Final = Path(__file__).parents[2]


def package_digest(package: Path = _PACKAGE) -> str:
    """Return one SHA-256 for all installed files: of the lines of `sha256sum`, by path below the package.

    What Python leaves there is left out, and the manual and scenarios, which only a wheel has there.
    """
    lines = []
    for path in sorted(package.rglob("*"), key=lambda each: each.relative_to(package).as_posix()):
        name = path.relative_to(package).as_posix()
        carried = name.startswith(("plans/library/scenarios/", "selftest/dossier/docs/"))
        if path.is_file() and "__pycache__" not in path.parts and not carried:
            lines.append(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {name}\n")
    return hashlib.sha256("".join(lines).encode("utf-8")).hexdigest()


def installed_packages() -> list[dict[str, str]]:
    """Return the package and all that it needs, by name: version, licence, version tested, what needs it.

    What an extra needs is there if it is installed. `spdx` is the licence where the package states an SPDX
    expression, else empty; `tested` is the version that the release was tested with, empty where none was.
    """
    found: dict[str, dict[str, str]] = {}
    extras = [
        each for each in metadata.metadata("uictest").get_all("Provides-Extra") or () if each not in _OURS
    ]
    for extra in ("", *sorted(extras)):
        waiting = ["uictest"] if not extra else list(_needs("uictest", extra))
        while waiting:
            name = _normal(waiting.pop())
            if name in found:
                continue
            try:
                of_package = metadata.distribution(name)
            except metadata.PackageNotFoundError:
                continue  # for another platform or Python, or of an extra that is not installed
            found[name] = {
                "name": name,
                "version": of_package.version,
                "tested": _tested().get(name, "") if name != "uictest" else "",
                "needed_by": f"extra {extra}" if extra else "uictest",
                **_licence(of_package),
            }
            waiting += _needs(name)
    return [found[name] for name in sorted(found)]


_OURS: Final = ("dev", "docs")
"""Extras of those who work on uictest."""


def _needs(package: str, extra: str = "") -> Iterator[str]:
    """Yield what a package needs, or only what an extra of it adds."""
    for line in metadata.distribution(package).requires or ():
        requirement, _, marker = line.partition(";")
        named = re.search(r"extra\s*==\s*[\"']([^\"']+)", marker)
        if (named[1] if named else "") == extra:
            yield re.split(r"[^\w.-]", requirement.strip(), maxsplit=1)[0]


@cache
def _tested() -> dict[str, str]:
    lines = (_PACKAGE / "constraints.txt").read_text("utf-8").splitlines()
    return dict(line.split("==") for line in lines)


def untested(packages: Sequence[dict[str, str]]) -> list[str]:
    """Return the packages that are installed in another version than the release was tested with."""
    return [
        f"{each['name']} {each['version']} (tested: {each['tested'] or 'none'})"
        for each in packages
        if each["name"] != "uictest" and each["version"] != each["tested"]
    ]


def cyclonedx(packages: Sequence[dict[str, str]]) -> str:
    """Return packages as a bill of materials: CycloneDX 1.5, JSON."""
    components = [
        {
            "type": "library",
            "name": each["name"],
            "version": each["version"],
            "purl": f"pkg:pypi/{each['name']}@{each['version']}",
            "licenses": [
                {"expression": each["spdx"]} if each["spdx"] else {"license": {"name": each["licence"]}}
            ],
        }
        for each in packages
    ]
    document = {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "components": components}
    return json.dumps(document, indent=1) + "\n"


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _licence(package: metadata.Distribution) -> dict[str, str]:
    """Return the licence that a package states: an SPDX expression, a classifier, or a short name."""
    stated = package.metadata
    expression = stated["License-Expression"] or "" if "License-Expression" in stated else ""
    classified = [
        each.rpartition(" :: ")[2]
        for each in stated.get_all("Classifier") or ()
        if each.startswith("License :: ") and each.count(" :: ") > 1
    ]
    name = (stated["License"] or "").strip() if "License" in stated else ""
    if not _NAME.fullmatch(name):  # the text of a licence, of which no line is its name
        name = ""
    return {"licence": expression or ", ".join(classified) or name or "not stated", "spdx": expression}


_NAME: Final = re.compile(r"[A-Za-z][\w .,()+/-]{1,60}")
