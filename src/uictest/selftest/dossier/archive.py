"""The files of the dossier, and the archive of them."""

from __future__ import annotations

import hashlib
import io
import json
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from importlib import metadata
from pathlib import Path
from typing import Any, Final

from uictest import __version__
from uictest.report import junit_text
from uictest.selftest.dossier.answers import answers_page
from uictest.selftest.dossier.build import is_release, last_release
from uictest.selftest.dossier.cover import cover
from uictest.selftest.dossier.inventory import cyclonedx, installed_packages, package_digest, untested
from uictest.selftest.dossier.manual import (
    QUESTIONS,
    TESTS,
    known_errors,
    pages,
    rendered,
    requirements,
)
from uictest.selftest.dossier.numbers import library_numbers, limits, numbers_page
from uictest.selftest.dossier.run_of_tests import TestRun, tests_page, tests_with_results
from uictest.selftest.dossier.sheet import COVER, Section, entries, sheet
from uictest.selftest.dossier.sources import public_sources, sources_page
from uictest.selftest.dossier.studies import studies, studies_page
from uictest.selftest.findings import Examination, findings_json, findings_suite

SCHEMA: Final = "uictest/dossier/2"
_EPOCH: Final = (1980, 1, 1, 0, 0, 0)
_PACKAGE: Final = Path(__file__).parents[2]


def dossier_files(
    examination: Examination, schemas: Mapping[str, str], made: datetime, run: TestRun | None = None
) -> dict[str, bytes]:
    """Return every file of the dossier by its path in the archive, the cover first.

    Args:
        examination: the self-test of this installation.
        schemas: of the files that users write, by the name of the file.
        made: when, UTC.
        run: of the tests, as its file records it.
    """
    examination = _without_places(examination)
    packages, kept, digest = installed_packages(), studies(), package_digest()
    sources, numbers, bounds = public_sources(), library_numbers(), limits()
    parts: dict[str, str] = {
        "questions.html": sheet("Questions of an assessor", body=rendered(QUESTIONS, "")),
        "known-answers.html": answers_page(examination),
        "known-answers.json": findings_json(examination),
        "known-answers.junit.xml": junit_text([findings_suite(examination)]),
        TESTS: tests_page(run),
        "numbers.html": numbers_page(numbers, bounds),
        "public-sources.html": sources_page(sources),
        "public-sources.json": json.dumps(sources, indent=1, ensure_ascii=False) + "\n",
        "studies.html": studies_page(kept),
        "studies.json": json.dumps(kept, indent=1) + "\n",
        "materials.html": _packages_page(packages),
        "materials.cdx.json": cyclonedx(packages),
        "constraints.txt": (_PACKAGE / "constraints.txt").read_text("utf-8"),
        "LICENSE.txt": _licence(),
    }
    for path in pages():
        page = sheet(f"Manual: {path.stem}", body=rendered(path, "manual"), home=f"../{COVER}")
        parts[f"manual/{path.stem}.html"] = page
    parts |= {f"schema/{name}": text for name, text in sorted(schemas.items())}
    contents = {name: text.encode("utf-8") for name, text in parts.items()}
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    facts = {
        "result of the self-test": examination.status,
        "run of the tests": "none was given" if run is None else run.sentence(),
        "made": made.strftime("%Y-%m-%d %H:%M:%S UTC"),
        "SHA-256 over the lines of sha256sum of all installed files, by path": digest,
        "packages unlike those tested": ", ".join(untested(packages)) or "none",
        **examination.about,
    }
    whole = {
        "schema": SCHEMA,
        "version": __version__,
        "is_release": is_release(),
        "last_release": last_release()._asdict(),
        "status": examination.status,
        "made": made.isoformat(timespec="seconds"),
        "installed_sha256": digest,
        "environment": dict(examination.about),
        "self_test": json.loads(parts["known-answers.json"])["checks"],
        "requirements": requirements(),
        "tests": tests_with_results(run),
        "test_run": None if run is None else run.form(),
        "known_errors": known_errors(),
        "numbers": numbers,
        "limits": bounds,
        "public_sources": sources["sources"],
        "studies": kept["studies"],
        "packages": packages,
        "files": digests,
    }
    return {
        COVER: cover(examination, facts, sources["sources"], list(contents)).encode("utf-8"),
        "dossier.json": (json.dumps(whole, indent=1, allow_nan=False) + "\n").encode("utf-8"),
        **contents,
    }


def packed(files: Mapping[str, bytes]) -> bytes:
    """Return an archive of files, the same bytes for the same files, with a list of their SHA-256."""
    listed = "".join(f"{hashlib.sha256(content).hexdigest()}  {name}\n" for name, content in files.items())
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in {**files, "SHA256SUMS": listed.encode("ascii")}.items():
            entry = zipfile.ZipInfo(f"uictest-{__version__}-dossier/{name}", _EPOCH)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)
    return buffer.getvalue()


def _without_places(examination: Examination) -> Examination:
    """Return an examination whose texts name no folder of this machine."""
    folders = {str(_PACKAGE.parent): "PACKAGES", str(Path.cwd()): "HERE", tempfile.gettempdir(): "TEMPORARY"}
    folders[str(Path.home())] = "HOME"
    known = sorted((each for each in folders.items() if len(each[0]) > 1), key=lambda each: -len(each[0]))

    def cleared(text: Any) -> Any:
        if isinstance(text, str):
            for folder, word in known:
                text = text.replace(folder, f"<{word}>")
        return text

    findings = tuple(
        replace(each, reason=cleared(each.reason), expected=cleared(each.expected), found=cleared(each.found))
        for each in examination.findings
    )
    return replace(
        examination,
        about={name: cleared(text) for name, text in examination.about.items()},
        findings=findings,
    )


def _packages_page(packages: Sequence[Mapping[str, str]]) -> str:
    """Return the page of all packages, and which of them are not those that were tested."""
    rows = [
        {**each, "tested": _tested_word(each), "spdx": "yes" if each["spdx"] else "no"} for each in packages
    ]
    headings = {
        "name": "name",
        "version": "installed",
        "tested": "tested",
        "needed_by": "needed by",
        "licence": "licence",
        "spdx": "SPDX",
    }
    said = "Licences are those that the packages state; SPDX says whether that is an SPDX expression."
    return sheet(
        "Installed packages", [Section("Packages", entries(rows, headings, ("licence",)))], said=[said]
    )


def _tested_word(package: Mapping[str, str]) -> str:
    if package["name"] == "uictest":
        return "-"
    if package["version"] == package["tested"]:
        return "same"
    return f"differs: {package['tested'] or 'no version'}"


def _licence() -> str:
    """Return the licence of the package, as it was installed with it."""
    texts = [each for each in metadata.files("uictest") or () if each.name == "LICENSE"]
    return texts[0].read_text("utf-8") if texts else metadata.metadata("uictest")["License-Expression"]
