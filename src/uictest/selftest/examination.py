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
from uictest.selftest.closed_forms import PHYSICS_CHECKS
from uictest.selftest.findings import Examination, Finding, Status
from uictest.selftest.known_stops import (
    Answer,
    Check,
    KnownStops,
    NotCheckedError,
    compiler_version,
    controller_checks,
    data_checks,
    judging_checks,
    reference_version,
    stop_checks,
)

_PACKAGES: Final = ("numpy", "scipy", "pydantic", "pyyaml", "pandas", "pyarrow")
"""Those that take part in figures and verdicts."""
_TRIAL: Final = b"uictest selftest"


def environment() -> dict[str, str]:
    """Return versions, processor and extras, by name."""
    return {
        "uictest": __version__,
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "platform": platform.platform(),
        "processor": _processor(),
        "C compiler": compiler_version(),
        **{name: version(name) for name in _PACKAGES},
        **{f"extra {name}": state for name, state in _versions_of_extras()},
    }


def environment_checks() -> Iterator[Check]:
    """Yield the checks of the installed files and of the cache."""
    what = "installed files that differ from those of the package"
    yield Check(
        "installed-files", "environment", what, _installed_files, unit="files", origin="installed files"
    )
    what = "what is written to the cache is read back"
    yield Check("cache", "environment", what, _answer_of_cache, advisory=True, origin="made by hand")


def _processor() -> str:
    slow = platform.machine().lower() in ("x86_64", "amd64") and rig.processor() == "v1"
    fused = ", without fused multiply-add: some twenty times slower" if slow else ""
    name, lanes = f"{platform.machine()} {rig.processor()}", rig.register_width()
    return f"{name}, {os.cpu_count()} cores, {lanes} lanes{fused}"


def _versions_of_extras() -> Iterator[tuple[str, str]]:
    own = distribution("uictest")
    for extra in own.metadata.get_all("Provides-Extra") or ():
        if extra == "dev":
            continue
        names = [
            match.group()
            for line in own.requires or ()
            if f'extra == "{extra}"' in line.replace("'", '"') and (match := re.match(r"[\w.-]+", line))
        ]
        present, absent = [], []
        for name in names:
            try:
                present.append(f"{name} {version(name)}")
            except PackageNotFoundError:
                absent.append(name)
        yield extra, f"absent: {', '.join(absent)}" if absent else f"present: {', '.join(present)}"


def _installed_files(stops: KnownStops) -> Answer:
    files = [file for file in distribution("uictest").files or () if file.parts[0] == "uictest" and file.hash]
    if not files:
        raise NotCheckedError(
            "installed from a working tree, which has no list of files: shipped-data compares its data"
        )
    differ = [str(file) for file in files if not _is_unchanged(file)]
    return Answer(0.0, float(len(differ)), ", ".join(differ[:5]))


def _is_unchanged(file: PackagePath) -> bool:
    assert file.hash is not None
    try:
        content = Path(str(file.locate())).read_bytes()
    except OSError:
        return False
    digest = hashlib.new(file.hash.mode, content).digest()
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode() == file.hash.value


def _answer_of_cache(stops: KnownStops) -> Answer:
    user_cache.write("selftest", _TRIAL, _TRIAL)
    content = user_cache.read("selftest", _TRIAL)
    if content == _TRIAL:
        return Answer("read back", "read back")
    words = "each run identifies compensations again; set UICTEST_CACHE to a folder of your own"
    return Answer("read back", "nothing", words)


def all_checks(stops: KnownStops) -> tuple[Check, ...]:
    """Return all checks; those of stored stops are asked of `stops`."""
    return (
        *stop_checks(stops),
        *PHYSICS_CHECKS,
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
    expected: float | str | None = None
    found: float | str | None = None
    try:
        expected, found, reason = check.answer(stops)
        if isinstance(expected, str) or isinstance(found, str):
            agree = expected == found
        else:  # not `>`: a number that is none must not pass
            agree = abs(found - expected) <= check.tolerance * abs(expected)
        status: Status = "pass" if agree else "warning" if check.advisory else "fail"
    except NotCheckedError as error:
        status, reason = "skipped", str(error)
    except Exception as error:
        status, reason = "error", f"{type(error).__name__}: {error}"
    described = check.id, check.group, check.what
    return Finding(*described, status, expected, found, check.tolerance, check.unit, reason, check.origin)
