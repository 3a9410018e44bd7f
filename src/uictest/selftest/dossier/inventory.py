"""What is installed: one digest of the package's files, and the packages that it needs with licences."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Sequence
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
    """Return the package and all that it needs without extras, by name: name, version and licence."""
    found: dict[str, dict[str, str]] = {}
    waiting = ["uictest"]
    while waiting:
        name = _normal(waiting.pop())
        if name in found:
            continue
        try:
            of_package = metadata.distribution(name)
        except metadata.PackageNotFoundError:
            continue  # for another platform or Python
        found[name] = {"name": name, "version": of_package.version, "licence": _licence(of_package)}
        for line in of_package.requires or ():
            requirement, _, marker = line.partition(";")
            if "extra" not in marker:
                waiting.append(re.split(r"[^\w.-]", requirement.strip(), maxsplit=1)[0])
    return [found[name] for name in sorted(found)]


def cyclonedx(packages: Sequence[dict[str, str]]) -> str:
    """Return packages as a bill of materials: CycloneDX 1.5, JSON."""
    components = [
        {
            "type": "library",
            "name": each["name"],
            "version": each["version"],
            "purl": f"pkg:pypi/{each['name']}@{each['version']}",
            "licenses": [{"license": {"name": each["licence"]}}],
        }
        for each in packages
    ]
    document = {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "components": components}
    return json.dumps(document, indent=1) + "\n"


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _licence(package: metadata.Distribution) -> str:
    """Return the licence that a package states: as an expression, by a classifier, or in its first line."""
    stated = package.metadata
    classified = [
        each.rpartition(" :: ")[2]
        for each in stated.get_all("Classifier") or ()
        if each.startswith("License :: ") and each.count(" :: ") > 1
    ]
    named = [stated[key] or "" for key in ("License-Expression", "License") if key in stated]
    text = next(filter(None, [*named[:1], ", ".join(classified), *named[1:]]), "")
    return text.strip().split("\n")[0] or "not stated"
