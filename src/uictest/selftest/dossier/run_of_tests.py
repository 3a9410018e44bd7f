"""A run of the tests as its JUnit file records it: which named tests passed, and of which program."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping
from typing import Any, Final, NamedTuple
from xml.etree import ElementTree

from uictest import __version__
from uictest.report import counted
from uictest.selftest.dossier.inventory import package_digest
from uictest.selftest.dossier.manual import named_tests
from uictest.selftest.dossier.sheet import Section, entries, sheet
from uictest.selftest.examination import environment

Outcomes = Counter[str]
"""`passed`, `failed`, `error` or `skipped` -> how many."""
_ORDER: Final = ("failed", "error", "skipped", "passed")
VERSION: Final = "uictest"
DIGEST: Final = "uictest_installed_sha256"
"""Properties of the record that say which program was tested; tests/conftest.py writes them."""


class TestRun(NamedTuple):
    """A run of the tests.

    Args:
        sha256: of the file.
        begun: when, as the file says; empty where it does not.
        about: what its properties state of program and machine.
        all_tests: outcomes of every test in it.
        by_test: file and name of a test, without its parameters -> outcomes.
    """

    sha256: str
    begun: str
    about: Mapping[str, str]
    all_tests: Outcomes
    by_test: Mapping[tuple[str, str], Outcomes]

    @property
    def program(self) -> str:
        """Whether the program that was tested is the one installed here."""
        digest = self.about.get(DIGEST)
        if digest is None:
            return "it does not say of which program"
        return "of the program that is installed here" if digest == package_digest() else "of another program"

    def form(self) -> dict[str, Any]:
        """Return it for programs."""
        stated = {"sha256": self.sha256, "begun": self.begun, "about": dict(self.about)}
        return {**stated, "program": self.program, "outcomes": dict(self.all_tests)}

    def sentence(self) -> str:
        """Return what came out, of which program."""
        when = f", begun {self.begun}" if self.begun else ""
        version = f" (uictest {self.about[VERSION]})" if VERSION in self.about else ""
        return f"{outcomes_text(self.all_tests)}{when}; {self.program}{version}"


def read_test_run(content: bytes) -> TestRun:
    """Read a JUnit file that pytest wrote. Raises ValueError where it is none."""
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        raise ValueError("it declares a document type, which no JUnit file does")
    try:
        root = ElementTree.fromstring(content)
    except ElementTree.ParseError as error:
        raise ValueError(f"it is no XML: {error}") from error
    by_test: dict[tuple[str, str], Outcomes] = {}
    for case in root.iter("testcase"):
        outcome = next((word for tag, word in _OUTCOMES.items() if case.find(tag) is not None), "passed")
        by_test.setdefault(_place(case.attrib), Counter())[outcome] += 1
    if not by_test:
        raise ValueError("it has no testcase")
    suite = next(root.iter("testsuite"), root)
    about = {each.get("name", ""): each.get("value", "") for each in suite.iter("property")}
    every = sum(by_test.values(), Counter())
    return TestRun(hashlib.sha256(content).hexdigest(), suite.get("timestamp", ""), about, every, by_test)


_OUTCOMES: Final = {"failure": "failed", "error": "error", "skipped": "skipped"}


def _place(case: Mapping[str, str]) -> tuple[str, str]:
    """Return file and name of a test: pytest writes `tests.files.test_writing` as the name of its class."""
    modules = [part for part in case.get("classname", "").split(".") if not part[:1].isupper()]
    return f"{'/'.join(modules)}.py", case.get("name", "").partition("[")[0]


def outcomes_text(outcomes: Outcomes) -> str:
    """Return outcomes in words, what went wrong first: `1 failed, 3 passed`."""
    return ", ".join(f"{outcomes[each]} {each}" for each in _ORDER if outcomes[each])


def tests_with_results(run: TestRun | None) -> list[dict[str, str]]:
    """Return every test that a requirement names, with its outcomes in a run where there is one."""
    named = named_tests()
    if run is None:
        return named
    missing: Outcomes = Counter()
    return [
        {**each, "result": outcomes_text(run.by_test.get((each["file"], each["test"]), missing)) or "not run"}
        for each in named
    ]


def tests_page(run: TestRun | None) -> str:
    """Return the page of every test that is named, with its file and, of a run that was given, its result."""
    said = ["These tests lie in the repository, below tests/; ./test runs them."]
    if run is None:
        said += ["None of them was run to make this dossier: what ran on this machine is the self-test."]
        said += ["./test --junitxml FILE records a run, and --tests FILE puts it in here."]
    else:
        said += [f"The run that was given: {run.sentence()}.", f"Its file has the SHA-256 {run.sha256}."]
        said += [f"{name}: {value}" for name, value in run.about.items()]
    named = tests_with_results(run)
    if run is not None:
        left_out = sum(each["result"] == "not run" for each in named)
        said += [f"Of {counted(len(named), 'named test')} {left_out} were not run."]
    headings = {"test": "test", "file": "file", "requirements": "requirements"}
    table = entries(named, headings | ({"result": "result"} if run else {}))
    title = f"{counted(len(named), 'test')} that requirements name"
    return sheet("Tests", [Section(title, table, anchored=True)], said=said)


def tested_program() -> dict[str, str]:
    """Return the properties by which a record says which program was tested, and on which machine."""
    return {VERSION: __version__, DIGEST: package_digest(), **environment()}
