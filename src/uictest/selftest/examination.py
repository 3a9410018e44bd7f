"""The examination of an installation: every check, and what surrounds them on this machine."""

import base64
import hashlib
import os
import platform
import re
from collections.abc import Iterator, Sequence
from importlib.metadata import PackageNotFoundError, PackagePath, distribution, version
from pathlib import Path
from typing import Final

from uictest import __version__, rig
from uictest.core import user_cache
from uictest.selftest.closed_forms import AIR_CHECKS, CONTACT_CHECKS, DRY_STOP_CHECKS, FRICTION_CHECKS
from uictest.selftest.findings import Examination, Finding, Status
from uictest.selftest.known_stops import (
    Answer,
    Check,
    KnownStops,
    NotCheckedError,
    compiler_version,
    reference_version,
)
from uictest.selftest.stored_answers import controller_checks, data_checks, judging_checks, stop_checks

_PACKAGES: Final = ("numpy", "scipy", "pydantic", "pyyaml", "pandas", "pyarrow")
"""Those that take part in figures and verdicts."""
_TRIAL: Final = b"uictest selftest"
_MOST_NAMED: Final = 5


def environment() -> dict[str, str]:
    """Return versions, processor and extras, by name."""
    return {
        "uictest": __version__,
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "platform": platform.platform(),
        "processor": _processor(),
        "C compiler": compiler_version(),
        **{name: version(name) for name in _PACKAGES},
        **{f"extra {name}": state for name, state in _extras()},
    }


def environment_checks() -> Iterator[Check]:
    """Yield the checks of the installed files and of the cache."""
    what = "installed files that differ from those of the package"
    yield Check(
        "installed-files", "environment", what, _installed_files, unit="files", origin="installed files"
    )
    what = "what is written to the cache is read back"
    yield Check("cache", "environment", what, _cache, advisory=True, origin="made by hand")


def _processor() -> str:
    slow = platform.machine().lower() in ("x86_64", "amd64") and rig.processor() == "v1"
    fused = ", without fused multiply-add: some twenty times slower" if slow else ""
    name, lanes = f"{platform.machine()} {rig.processor()}", rig.register_width()
    return f"{name}, {os.cpu_count()} cores, {lanes} lanes{fused}"


def _extras() -> Iterator[tuple[str, str]]:
    """Yield every optional extra of the package, and what of it is installed."""
    own = distribution("uictest")
    for extra in own.metadata.get_all("Provides-Extra") or ():
        if extra == "dev":
            continue
        names = [
            match.group()
            for line in own.requires or ()
            if f'extra == "{extra}"' in line.replace("'", '"') and (match := re.match(r"[\w.-]+", line))
        ]
        found = {name: _version_of(name) for name in names}
        missing = [name for name, installed in found.items() if not installed]
        installed = ", ".join(f"{name} {number}" for name, number in found.items() if number)
        yield extra, f"absent: {', '.join(missing)}" if missing else f"present: {installed}"


def _version_of(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def _installed_files(stops: KnownStops) -> Answer:
    files = [each for each in distribution("uictest").files or () if each.parts[0] == "uictest" and each.hash]
    if not files:
        raise NotCheckedError(
            "installed from a working tree, which has no list of files: shipped-data compares its data"
        )
    differ = [str(each) for each in files if not _unchanged(each)]
    return Answer(0.0, float(len(differ)), ", ".join(differ[:_MOST_NAMED]))


def _unchanged(file: PackagePath) -> bool:
    """Return whether an installed file has the digest that the package gives for it."""
    assert file.hash is not None
    try:
        content = Path(str(file.locate())).read_bytes()
    except OSError:
        return False
    digest = hashlib.new(file.hash.mode, content).digest()
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode() == file.hash.value


def _cache(stops: KnownStops) -> Answer:
    user_cache.write("selftest", _TRIAL, _TRIAL)
    found = user_cache.read("selftest", _TRIAL)
    if found == _TRIAL:
        return Answer("read back", "read back")
    words = "each run identifies compensations again; set UICTEST_CACHE to a folder of your own"
    return Answer("read back", "nothing", words)


def all_checks(stops: KnownStops) -> tuple[Check, ...]:
    """Return all checks; those of stored stops are asked of `stops`."""
    return (
        *stop_checks(stops),
        *DRY_STOP_CHECKS,
        *AIR_CHECKS,
        *CONTACT_CHECKS,
        *FRICTION_CHECKS,
        *judging_checks(),
        *controller_checks(),
        *data_checks(),
        *environment_checks(),
    )


def examine(stops: KnownStops, checks: Sequence[Check] | None = None) -> Examination:
    """Ask every question, or these; an exception in a check is a finding with the status `error`."""
    asked = all_checks(stops) if checks is None else checks
    about = {**environment(), "stored stops": f"computed by uictest {reference_version()}"}
    return Examination("selftest", "", about, tuple(_finding(check, stops) for check in asked))


def _finding(check: Check, stops: KnownStops) -> Finding:
    try:
        answer = check.answer(stops)
    except NotCheckedError as error:
        return _without_answer(check, "skipped", str(error))
    except Exception as error:
        return _without_answer(check, "error", f"{type(error).__name__}: {error}")
    status = _status(check, answer)
    described = check.id, check.group, check.what
    return Finding(
        *described,
        status,
        answer.expected,
        answer.found,
        check.tolerance,
        check.unit,
        answer.words,
        check.origin,
    )


def _without_answer(check: Check, status: Status, reason: str) -> Finding:
    described = check.id, check.group, check.what
    return Finding(*described, status, None, None, check.tolerance, check.unit, reason, check.origin)


def _status(check: Check, answer: Answer) -> Status:
    if _agree(answer.expected, answer.found, check.tolerance):
        return "pass"
    return "warning" if check.advisory else "fail"


def _agree(expected: float | str, found: float | str, tolerance: float) -> bool:
    if isinstance(expected, str) or isinstance(found, str):
        return expected == found
    # Not `>`: a number that is none must not pass.
    return abs(found - expected) <= tolerance * abs(expected)
