"""The files of the dossier, and the archive of them."""

from __future__ import annotations

import hashlib
import io
import json
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from functools import partial
from importlib import metadata
from operator import itemgetter
from pathlib import Path
from typing import Any, Final

from markupsafe import Markup, escape

from uictest import __version__
from uictest.core.document import Column, Lines, Table
from uictest.report import counted, junit_text
from uictest.report.page import render
from uictest.selftest.dossier.inventory import cyclonedx, installed_packages, package_digest
from uictest.selftest.dossier.manual import QUESTIONS, known_errors, pages, rendered, requirements
from uictest.selftest.dossier.studies import studies, study_table
from uictest.selftest.findings import Examination, finding_document, findings_json, findings_suite

SCHEMA: Final = "uictest/dossier/1"
_EPOCH: Final = (1980, 1, 1, 0, 0, 0)
_PACKAGE: Final = Path(__file__).parents[2]
_TITLES: Final = {
    "questions.html": "Questions of an assessor, answered, each with its place",
    "known-answers.html": "Self-test: what was expected and found",
    "manual/requirements.html": "Requirements of the tool with their tests, constraints on use",
    "manual/tool-errors.html": "Error analysis: how each function could lie, what detects it, what remains",
    "manual/known-errors.html": "Known errors",
    "manual/trust.html": "Purpose, domain, verification, uncertainty, configuration control",
    "manual/validation.html": "Validation",
    "public-sources.html": "Public sources beside the rig: bias, spread and misses",
    "studies.html": "Studies and their results, misses first",
    "materials.html": "Installed packages with versions and licences",
}
"""What an assessor opens first -> what it is; the rest follows by name."""


def dossier_files(examination: Examination, schemas: Mapping[str, str], made: datetime) -> dict[str, bytes]:
    """Return every file of the dossier by its path in the archive, the cover first.

    Args:
        examination: the self-test of this installation.
        schemas: of the files that users write, by the name of the file.
        made: when, UTC.
    """
    examination = _without_places(examination)
    packages, kept = installed_packages(), studies()
    sources = json.loads((_PACKAGE / "selftest" / "public_sources.json").read_text("utf-8"))
    parts: dict[str, str] = {
        "questions.html": _page("Questions of an assessor", Markup(rendered(QUESTIONS, ""))),
        "known-answers.html": _answers_page(examination),
        "known-answers.json": findings_json(examination),
        "known-answers.junit.xml": junit_text([findings_suite(examination)]),
        "public-sources.html": _page("Public sources", Markup(""), _source_table(sources["sources"])),
        "public-sources.json": json.dumps(sources, indent=1, ensure_ascii=False) + "\n",
        "studies.html": _page("Studies", Markup(""), study_table(kept)),
        "studies.json": json.dumps(kept, indent=1) + "\n",
        "materials.html": _page("Installed packages", Markup(""), _package_table(packages)),
        "materials.cdx.json": cyclonedx(packages),
        "constraints.txt": (_PACKAGE / "constraints.txt").read_text("utf-8"),
        "LICENSE.txt": _licence(),
    }
    for path in pages():
        page = _page(path.stem, Markup(rendered(path, "manual")), home="../index.html")
        parts[f"manual/{path.stem}.html"] = page
    parts |= {f"schema/{name}": text for name, text in sorted(schemas.items())}
    contents = {name: text.encode("utf-8") for name, text in parts.items()}
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    facts = {
        "result of the self-test": examination.status,
        "made": made.strftime("%Y-%m-%d %H:%M:%S UTC"),
        "SHA-256 of the installed files": package_digest(),
        **examination.about,
    }
    whole = {
        "schema": SCHEMA,
        "version": __version__,
        "status": examination.status,
        "made": made.isoformat(timespec="seconds"),
        "installed_sha256": package_digest(),
        "environment": dict(examination.about),
        "self_test": json.loads(parts["known-answers.json"])["checks"],
        "requirements": requirements(),
        "known_errors": known_errors(),
        "public_sources": sources["sources"],
        "studies": kept["studies"],
        "packages": packages,
        "files": digests,
    }
    cover = _cover(examination, facts, list(contents))
    return {
        "index.html": cover.encode("utf-8"),
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


def _cover(examination: Examination, facts: Mapping[str, str], names: Sequence[str]) -> str:
    """Return the first page: whether the self-test passed, of what and where, and a link to every part."""
    rest = ["dossier.json", *sorted(set(names) - set(_TITLES)), "SHA256SUMS"]
    opened_first = [(name, title) for name, title in _TITLES.items() if name in names]
    items = "".join(f'<li><a href="{name}">{escape(title)}</a></li>' for name, title in opened_first)
    others = "".join(f'<li><a href="{name}">{name}</a></li>' for name in rest)
    table = Table(
        [
            Column(heading="what", text=lambda each: each[0], literal=True),
            Column(heading="is", text=lambda each: each[1], wraps=True),
        ],
        [each for each in facts.items() if each[1]],
    )
    statuses = [each.status for each in examination.findings]
    counts = ", ".join(f"{statuses.count(each)} {each}" for each in dict.fromkeys(statuses))
    failed = examination.status in ("fail", "error")
    headline = (
        f"{'FAILED' if failed else 'Passed'}: {counted(len(statuses), 'check')} of the self-test, {counts}"
    )
    body = Markup(f"<h2>Read first</h2><ul>{items}</ul><h2>All other files</h2><ul>{others}</ul>")
    return render(
        "dossier.html.j2",
        with_plots=False,
        running_head=f"uictest {__version__}",
        headline=headline,
        subline=f"Dossier of uictest {__version__} for an assessor",
        table=table,
        label="Installation",
        body=body,
        home="",
    )


def _page(title: str, body: Markup, table: Table | None = None, home: str = "index.html") -> str:
    return render(
        "dossier.html.j2",
        with_plots=False,
        running_head=title,
        headline=title,
        subline=f"uictest {__version__}",
        table=table,
        label=title,
        body=body,
        home=home,
    )


def _answers_page(examination: Examination) -> str:
    """Return the page of what was expected and found."""
    _, table, remarks = finding_document(examination).sections
    assert isinstance(table, Table)
    assert isinstance(remarks, Lines)
    lines = "".join(f"<li>{escape(each)}</li>" for each in remarks.sentences)
    return _page("Self-test", Markup(f"<ul>{lines}</ul>"), table)


def _package_table(packages: Sequence[Mapping[str, str]]) -> Table:
    columns = [
        Column(heading=name, text=itemgetter(name), wraps=name == "licence")
        for name in ("name", "version", "licence")
    ]
    return Table(columns, packages)


def _source_table(sources: Sequence[Mapping[str, Any]]) -> Table:
    """Return a row for each public source that the rig was compared with, misses first."""
    rows = sorted(sources, key=lambda each: each["result"] != "misses")
    columns: dict[str, Callable[[Mapping[str, Any]], object]] = {
        "source": itemgetter("title"),
        "place": itemgetter("place"),
        "fitted": itemgetter("fitted"),
        "predicted": itemgetter("predicted_numbers"),
        "missed": itemgetter("missed"),
        "bias, %": itemgetter("bias_percent"),
        "spread, %": itemgetter("spread_percent"),
        "worst, %": itemgetter("worst_percent"),
        "worst is": itemgetter("worst"),
        "result": itemgetter("result"),
    }
    return Table(
        [
            Column(heading=heading, text=partial(_cell, read), wraps=heading in ("place", "fitted"))
            for heading, read in columns.items()
        ],
        rows,
    )


def _cell(read: Callable[[Mapping[str, Any]], object], row: Mapping[str, Any]) -> str:
    value = read(row)
    return "-" if value is None else str(value).replace("`", "")


def _licence() -> str:
    """Return the licence of the package, as it was installed with it."""
    texts = [each for each in metadata.files("uictest") or () if each.name == "LICENSE"]
    return texts[0].read_text("utf-8") if texts else metadata.metadata("uictest")["License-Expression"]
