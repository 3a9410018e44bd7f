"""The dossier: complete, the same for the same installation, its links whole, no place of the machine."""

import hashlib
import io
import json
import re
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path, PurePosixPath
from posixpath import normpath

import pytest
from markupsafe import escape

import uictest
from uictest import selftest
from uictest.selftest import dossier
from uictest.selftest.dossier.answers import requirements_of
from uictest.selftest.dossier.build import Release, identity
from uictest.selftest.dossier.cover import meaning
from uictest.selftest.dossier.inventory import untested
from uictest.selftest.findings import Examination, Finding

REPOSITORY = Path(__file__).parents[2]
MADE = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
PASSED = Finding("tank", "physics", "a tank", "pass", 1.0, 1.0, 0.0, "K")
FAILED = replace(PASSED, id="stop", status="fail", found=2.0, reason="1 differs")
SCHEMAS = {"scenario.schema.json": "{}\n"}
_LINK = re.compile(r'(?:href|src)="([^"]*)"')
_ID = re.compile(r'id="([^"]*)"')


def files_of(*findings, about=None, run=None):
    examination = Examination("selftest", "", about or {"python": "CPython 3.11"}, findings)
    return dossier.dossier_files(examination, SCHEMAS, MADE, run)


@pytest.fixture(scope="module")
def files():
    return files_of(PASSED)


PLACES = [str(Path.home()), str(Path.cwd()), tempfile.gettempdir(), str(REPOSITORY)]
NAMES_PLACES = "; ".join(f"no file {place}/x" for place in PLACES)


@pytest.fixture(scope="module")
def failed(stops):
    """A dossier of two real checks and of three made up, two of them missed, with a run of the tests."""
    real = selftest.examine(stops, list(selftest.all_checks(stops))[:2]).findings
    relative = replace(PASSED, id="relative", tolerance=2e-3, origin="closed form")
    places = replace(FAILED, id="places", status="error", reason=NAMES_PLACES, expected=NAMES_PLACES)
    run = run_of(dossier.tested_program()["uictest_installed_sha256"])
    return files_of(*real, relative, FAILED, places, about={"cache": NAMES_PLACES}, run=run)


@pytest.fixture(scope="module")
def whole(files):
    return json.loads(files["dossier.json"])


def text(files, name):
    return files[name].decode("utf-8")


def test_it_holds_every_page_of_the_manual_and_what_an_assessor_asks_for(files):
    pages = {path.stem for path in REPOSITORY.glob("docs/*.md")} - {"index"} | {"CHANGELOG"}
    assert {f"manual/{page}.html" for page in pages} <= set(files)
    parts = {"known-answers.html", "studies.html", "materials.cdx.json", "constraints.txt", "questions.html"}
    assert parts <= set(files)
    assert "Apache License" in text(files, "LICENSE.txt")
    assert files["schema/scenario.schema.json"] == b"{}\n"


def test_every_link_leads_to_a_place_in_it(files):
    anchors = {name: set(_ID.findall(text(files, name))) for name in files if name.endswith(".html")}
    checked = 0
    for page in anchors:
        for target in _LINK.findall(text(files, page)):
            if "://" in target or target.startswith(("#main", "data:")):
                continue
            name, _, anchor = target.partition("#")
            place = normpath(str(PurePosixPath(page).parent / name)) if name else page
            assert place in {*files, "SHA256SUMS"}, f"{page}: {target}"
            assert not anchor or anchor in anchors[place], f"{page}: {target}"
            checked += 1
    assert checked > 300


def test_what_is_not_in_the_archive_is_named_with_its_path_and_is_no_link(files):
    page = text(files, "manual/trust.html")
    assert "<span>Polach's published values (tests/physics/test_polach.py)</span>" in page.replace(
        "&#39;", "'"
    )
    assert '<a href="constraints.txt">' in text(files, "questions.html")
    for name in files:
        if name.endswith(".html"):
            assert not re.search(r"<a(?! href| class)", text(files, name)), name


def test_the_same_installation_makes_the_same_bytes(files):
    assert dossier.packed(files) == dossier.packed(files_of(PASSED))


def test_the_archive_lists_the_digest_of_each_file(files):
    archive = zipfile.ZipFile(io.BytesIO(dossier.packed(files)))
    names = [PurePosixPath(name).name for name in archive.namelist()[:2]]
    assert names == ["index.html", "dossier.json"]
    folder = PurePosixPath(archive.namelist()[0]).parent
    for line in archive.read(f"{folder}/SHA256SUMS").decode().splitlines():
        digest, _, name = line.partition("  ")
        assert hashlib.sha256(archive.read(f"{folder}/{name}")).hexdigest() == digest
    assert len(archive.namelist()) == len(files) + 1
    assert {each.date_time for each in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_a_failed_self_test_stands_on_the_cover(files, failed):
    assert "FAILED: 5 checks of the self-test, 3 pass, 1 fail, 1 error" in text(failed, "index.html")
    assert json.loads(failed["dossier.json"])["status"] == "error"
    assert Examination("selftest", "", {}, (PASSED, FAILED)).status == "fail"
    assert "FAILED" not in text(files, "index.html")


def test_no_folder_of_the_machine_is_named(failed):
    assert "no file &lt;" in text(failed, "known-answers.html")
    for name, content in failed.items():
        for place in PLACES:
            assert len(place) < 2 or f"{place}/" not in content.decode("utf-8"), name


def test_programs_find_requirements_with_tests_errors_studies_and_packages(whole):
    assert whole["schema"] == "uictest/dossier/2"
    assert [each["id"] for each in whole["requirements"]] == [
        f"TOOL-{number}" for number in range(1, len(whole["requirements"]) + 1)
    ]
    assert all(each["tests"] for each in whole["requirements"])
    page = (REPOSITORY / "docs/known-errors.md").read_text("utf-8")
    assert len(whole["known_errors"]) == sum(line.startswith("| ") for line in page.splitlines()) - 1
    assert {each["name"] for each in whole["packages"]} >= {"uictest", "numpy", "numba", "pydantic"}
    needed = [each for each in whole["packages"] if each["needed_by"] == "uictest"]
    assert {each["licence"] for each in needed} & {"", "not stated"} == set()
    assert re.fullmatch(r"[0-9a-f]{64}", whole["installed_sha256"])


def test_every_study_of_the_catalogue_is_there_with_a_result_or_the_reason_for_none(files, whole):
    from studies.study import STUDIES

    assert [each["name"] for each in whole["studies"]] == list(STUDIES)
    page = text(files, "studies.html")
    for kept in whole["studies"]:
        assert f'id="{kept["name"]}"' in page
        if kept["result"] == "not run":
            assert kept["why"]
            assert escape(f"Not run in this dossier: {kept['why']}.") in page
        else:
            assert all(escape(note) in page for note in kept["notes"]), kept["name"]


def test_results_that_are_kept_are_those_of_the_catalogue(whole):
    from studies.study import STUDIES

    for kept in whole["studies"]:
        if kept["result"] == "not run":
            continue
        quantities = {each.key: each for each in STUDIES[kept["name"]].quantities}
        assert [each["key"] for each in kept["quantities"]] == list(quantities)
        for each in kept["quantities"]:
            now = quantities[each["key"]]
            assert each["status"] == now.status
            assert (each["band"] or {}).get("upper") == (now.band and now.band.upper)
            assert each["declared_miss"] == now.declared_miss
            assert not each["fails"], f"{kept['name']}: {each['key']}"


def test_misses_stand_first_among_studies_and_in_each(files, whole):
    order = ("misses", "holds", "shown", "not run")
    _, overview, *sections = text(files, "studies.html").split("<section")
    shown = re.findall(rf">({'|'.join(order)})<", overview)
    assert len(shown) == len(whole["studies"])
    for each in (shown, *(re.findall(r">(misses|holds|shown)<", section) for section in sections)):
        assert each == sorted(each, key=order.index)


@pytest.mark.slow
def test_a_release_keeps_the_results_of_every_study(whole):
    """Run ./reproduce and scripts/dossier_studies.py."""
    assert [each["name"] for each in whole["studies"] if each["result"] == "not run"] == []


def test_the_range_of_repeats_is_shown(files):
    section = text(files, "studies.html").partition('id="slide-test"')[2].partition("</section>")[0]
    assert re.search(r"17\.5\d* s</td>.*?17\.\d+ \.\. 17\.\d+", section, re.DOTALL)


def test_every_number_of_every_public_source_is_shown_with_the_tolerance(files):
    page, read = text(files, "public-sources.html"), json.loads(files["public-sources.json"])
    assert f"within {read['tolerance_percent']:g} %" in page
    for source in read["sources"]:
        section = page.partition(f'id="{source["name"]}"')[2].partition("</section>")[0]
        assert section.count('<th scope="row">') == len(source["numbers"])
        missed = [
            each for each in source["numbers"] if each["status"] == "predicted" and each["result"] == "misses"
        ]
        assert len(missed) == source["missed"]


SOURCE = {"kind": "measured", "title": "A train", "result": "misses", "missed": 1, "predicted_numbers": 2}
PREDICTED = {"quantity": "time", "status": "predicted", "difference_percent": 2.0, "result": "holds"}


def test_the_cover_says_what_passing_means_from_the_numbers_of_the_sources():
    fitted = {**PREDICTED, "quantity": "distance", "status": "fitted"}
    missed = {**PREDICTED, "quantity": "deceleration", "difference_percent": -7.0, "result": "misses"}
    other = {"kind": "computed", "title": "A theory", "result": "holds", "missed": 0, "predicted_numbers": 3}
    said = list(meaning([{**SOURCE, "numbers": [PREDICTED, fitted, missed]}, {**other, "numbers": []}]))
    assert said[1:] == [
        (
            "Public sources: 1 of 2 holds (A theory: another theory, solved by the authors of uictest), "
            "1 miss; of 5 predicted numbers 1 miss."
        ),
        "A train: 1 of 2 predicted numbers misses: time +2.0 % (holds), deceleration -7.0 % (misses).",
        "Independent verification: none.",
    ]


def test_the_cover_says_of_a_build_between_releases_that_it_is_none(files):
    release = Release("0.2.0", "2026-11-22")
    assert identity("0.2.0", release) == "This build is uictest 0.2.0, the release of 2026-11-22."
    assert "which is not a release. It differs from 0.2.0 of 2026-11-22" in identity("0.3.0.dev0", release)
    assert escape(identity()) in text(files, "index.html")


def test_every_named_test_has_its_file_in_the_archive(files, whole):
    page = text(files, "tests.html")
    named = {test["name"] for each in whole["requirements"] for test in each["tests"]}
    assert {each["test"] for each in whole["tests"]} == named
    assert sorted(re.findall(r'<tr id="(test_\w+)"', page)) == sorted(named)
    for each in whole["tests"]:
        assert f"def {each['test']}(" in (REPOSITORY / each["file"]).read_text("utf-8")
        assert each["requirements"]
        assert each["file"] in page
    rendered = text(files, "manual/requirements.html")
    assert all(f'href="../tests.html#{name}"' in rendered for name in named)


def test_a_test_has_the_functions_whose_error_it_detects(whole):
    functions = {each["test"]: each["functions"] for each in whole["tests"]}
    assert functions["test_firm_is_never_said_where_the_sample_contradicts_it"] == "firmness"


def test_each_requirement_and_each_mention_of_it_can_be_followed(files):
    assert '<td id="TOOL-13">' in text(files, "manual/requirements.html")
    assert '<td><a href="requirements.html#TOOL-30">TOOL-30</a></td>' in text(
        files, "manual/tool-errors.html"
    )
    assert 'href="manual/requirements.html#TOOL-13"' in text(files, "questions.html")


def test_every_number_of_the_library_is_there_with_mark_source_and_range(files, whole):
    numbers = whole["numbers"]
    library = REPOSITORY / "src/uictest/plans/library"
    parts = {f"{path.parent.name}/{path.stem}" for path in library.glob("*/*.yaml")}
    without = {each for each in parts if each.startswith("channel_maps/")} | {"pads/constant"}
    assert {each["part"] for each in numbers} == parts - without
    assert {each["mark"] for each in numbers} == {"stated", "published", "identified", "chosen"}
    assert all(each["source"] for each in numbers)
    [friction] = [
        each for each in numbers if (each["part"], each["key"]) == ("rails/leaf-layer", "friction_decay")
    ]
    assert friction["range"] == "0.1 s/m .. 0.4 s/m"
    page = text(files, "numbers.html")
    marks = [each["mark"] for each in numbers]
    assert f"{len(marks)} numbers of the library: {marks.count('chosen')} chosen" in page
    assert page.count("<tr>") >= len(numbers)
    assert '<a href="#rails-leaf-layer">rails/leaf-layer</a>' in page


def test_every_limit_says_that_it_is_not_verified(whole):
    bounds = {(each["criterion"], each["limit"]): each for each in whole["limits"]}
    slide = bounds["minimum-slide", "> 35 %"]
    assert (slide["clause"], slide["mark"]) == ("Appendix B", "stated")
    assert slide["verified"] == "no: read second-hand"
    assert bounds["energy-balance", "< 0.1 %"]["verified"] == "ours, no leaflet's"


def test_answers_say_that_the_tolerance_is_relative_and_where_they_come_from(failed):
    page = text(failed, "known-answers.html")
    assert "as a share of what is expected" in page
    assert re.search(r">0\.2 %<.*>closed form<.*>TOOL-51<", page, re.DOTALL)


def test_every_check_of_the_self_test_has_a_requirement_and_an_origin(stops):
    checks = selftest.all_checks(stops)
    origins = {each.id: each.origin for each in checks}
    assert origins["creep-on-wet-rail"] == "publication"
    assert origins["textbook-stop"] == "closed form of the rig's own force"
    known = {each["id"] for each in dossier.requirements()}
    for each in checks:
        of = requirements_of(replace(PASSED, id=each.id, group=each.group))
        assert set(of.split(", ")) <= known


def test_packages_of_extras_are_listed_and_what_differs_from_the_tested_is_marked(files, whole):
    needed = {each["needed_by"] for each in whole["packages"]}
    assert "extra fmu" in needed
    same = {"name": "scipy", "version": "1", "tested": "1"}
    assert untested([{**same, "name": "numpy", "version": "2"}, same]) == ["numpy 2 (tested: 1)"]
    assert all(each in text(files, "index.html") for each in untested(whole["packages"]))
    licences = " ".join(each["licence"] for each in whole["packages"])
    assert not re.search("===|Copyright", licences)
    bill = {each["name"]: each["licenses"] for each in json.loads(files["materials.cdx.json"])["components"]}
    assert bill["uictest"] == [{"expression": "Apache-2.0"}]


def test_known_errors_for_programs_lead_into_the_archive(files, whole):
    targets = re.findall(r"\]\(([^)#]+)", json.dumps(whole["known_errors"]))
    assert targets
    assert set(targets) <= set(files)


def test_twenty_questions_and_more_have_an_answer_with_its_place(files):
    rows = re.findall(r"<tr>\s*<td>(\d+)</td>(.*?)</tr>", text(files, "questions.html"), re.DOTALL)
    assert [int(number) for number, _ in rows] == list(range(1, len(rows) + 1))
    assert len(rows) >= 20
    assert all(_LINK.search(row) for _, row in rows)


def test_the_real_self_test_is_in_it(stops, failed):
    found = json.loads(failed["dossier.json"])["self_test"]
    assert [each["id"] for each in found[:2]] == [each.id for each in selftest.all_checks(stops)][:2]
    assert [each["status"] for each in found[:2]] == ["pass", "pass"]


RUN = """<?xml version="1.0" encoding="utf-8"?>
<testsuites><testsuite name="pytest" timestamp="2026-01-02T03:04:05">
<properties><property name="uictest" value="9.9"/><property name="uictest_installed_sha256" value="{digest}"/>
</properties>
<testcase classname="tests.evaluation.test_judgement" name="test_nan_never_passes[upper]"/>
<testcase classname="tests.evaluation.test_judgement" name="test_nan_never_passes[lower]"><failure/>
</testcase>
<testcase classname="tests.evaluation.test_bounds.TestAll" name="test_nan_and_infinity_never_hold"/>
<testcase classname="tests.cli.test_entry" name="test_x"><skipped/></testcase></testsuite></testsuites>"""


def run_of(digest):
    return dossier.read_test_run(RUN.format(digest=digest).encode())


def test_a_run_of_the_tests_stands_beside_the_requirements_and_on_the_cover(failed):
    whole = json.loads(failed["dossier.json"])
    results = {each["test"]: each["result"] for each in whole["tests"]}
    assert results["test_nan_never_passes"] == "1 failed, 1 passed"
    assert results["test_nan_and_infinity_never_hold"] == "1 passed"
    assert results["test_validity_comes_before_requirements"] == "not run"
    assert whole["test_run"]["outcomes"] == {"passed": 2, "failed": 1, "skipped": 1}
    said = "1 failed, 1 skipped, 2 passed, begun 2026-01-02T03:04:05; of the program that is installed here"
    assert said in text(failed, "index.html")
    assert said in text(failed, "tests.html")
    assert f"{len(results) - 2} were not run" in text(failed, "tests.html")


def test_a_run_of_another_program_is_called_so(files):
    """The cover has this sentence: the test before reads it there."""
    assert "of another program (uictest 9.9)" in run_of("0" * 64).sentence()
    assert "none was given" in text(files, "index.html")


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (b"no xml", "no XML"),
        (b"<testsuites/>", "no testcase"),
        (b'<!DOCTYPE x [<!ENTITY a "b">]><testsuite>&a;</testsuite>', "document type"),
    ],
)
def test_what_is_no_record_of_tests_is_refused(content, why):
    with pytest.raises(ValueError, match=why):
        dossier.read_test_run(content)


def test_the_record_of_this_suite_says_which_program_is_tested(tmp_path):
    """pytest itself writes the file: in a process of its own, as it runs once per process."""
    junit = tmp_path / "junit.xml"
    place = "tests/evaluation/test_bounds.py"
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", place, f"--junitxml={junit}"]
    subprocess.run(command, cwd=REPOSITORY, check=True, capture_output=True)
    run = dossier.read_test_run(junit.read_bytes())
    assert run.about["uictest_installed_sha256"] == dossier.tested_program()["uictest_installed_sha256"]
    assert run.by_test[place, "test_nan_and_infinity_never_hold"]["passed"] > 0


def test_the_verdict_by_hand_adds_up_from_the_speeds_of_the_stop():
    """The speeds of the page are those of the stop; trapezoids over them give its distance."""
    page = (REPOSITORY / "docs/trust.md").read_text("utf-8").partition("### A verdict by hand")[2]
    speeds = [float(each) for each in re.search(r"\n\n((?:    [\d. ]+\n)+)", page)[1].split()]
    stop = uictest.simulate("dry-120")
    assert speeds == pytest.approx(list(3.6 * stop["speed"][::100][: len(speeds)]), abs=0.051)
    area = sum((a + b) / 7.2 for a, b in pairwise(speeds)) + speeds[-1] / 7.2 * (27.85 - len(speeds) + 1)
    assert f"add up to {area:.1f} m" in " ".join(page.split())
