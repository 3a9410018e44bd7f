import sys
from types import SimpleNamespace
from urllib.parse import unquote

import pytest
from hypothesis import given, strategies as st
from jinja2 import DictLoader, Environment
from markupsafe import Markup

from uictest.report.page import page_html, rendering
from uictest.report.page.rendering import TemplateCache, case_anchor, fragment
from uictest.report.traces.trace import trace_of

from ..builders import make_content, make_recording, make_result


def test_what_cannot_be_seen_is_spelled_out_and_markup_of_ours_is_left_alone():
    assert rendering._visible("a\u202eb\x00") == "a\\u202eb\\x00"
    ours = Markup("<b>\n</b>")
    assert rendering._visible(ours) is ours
    assert rendering._visible(3) == 3


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache of its own; what earlier programs left in the temporary folder is not seen."""
    (tmp_path / "file").write_text("not a folder")
    (tmp_path / "cache").mkdir()
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    return tmp_path / "cache"


def _rendered(source):
    environment = Environment(
        loader=DictLoader({"page": source}), bytecode_cache=TemplateCache(), autoescape=True
    )
    return environment.get_template("page").render(name="WSP")


def test_a_template_is_compiled_once(cache, monkeypatch):
    assert [_rendered("a {{ name }}"), _rendered("the {{ name }}")] == ["a WSP", "the WSP"]
    monkeypatch.setattr(Environment, "compile", lambda *_: pytest.fail("compiled again"))
    assert _rendered("the {{ name }}") == "the WSP"


def test_damaged_code_is_compiled_anew(cache):
    """Half a template is still something that Python would load and run."""
    _rendered("the {{ name }}")
    (kept,) = cache.iterdir()
    kept.write_bytes(kept.read_bytes().replace(b"the ", b"THE "))
    assert _rendered("the {{ name }}") == "the WSP"


def test_the_running_head_holds_nothing_that_ends_it():
    style = rendering._running_head('a"; } </style><b>\\\n\u202e')
    assert not set(style.partition('content: "')[2].rpartition('"')[0]) & set('"<>;{}\n\u202e')
    assert style.count('"') == 2


def test_the_plotting_script_is_what_was_published_and_is_not_imported():
    script, style = rendering.uplot()
    assert script.startswith("/*! https://github.com/leeoniya/uPlot (v1.6.31) */")
    assert ".u-over" in style
    assert "youplot" not in sys.modules


@pytest.mark.parametrize("damage", ["no package", "no file", "another file"])
def test_without_the_plotting_script_a_page_keeps_its_drawings_and_says_why(damage, tmp_path, monkeypatch):
    (tmp_path / "vendor").mkdir()
    if damage == "another file":
        for name in rendering._UPLOT:
            (tmp_path / "vendor" / name).write_text("alert(1)")
    spec = SimpleNamespace(origin=str(tmp_path / "__init__.py"))
    monkeypatch.setattr(rendering, "find_spec", lambda _: None if damage == "no package" else spec)
    rendering.uplot.cache_clear()
    try:
        result = make_result()
        html = page_html(make_content(result, traces={result.id: trace_of(make_recording())}))
    finally:
        rendering.uplot.cache_clear()
    assert "alert(1)" not in html
    assert '<svg class="panels"' in html
    assert "The plots do not answer: uPlot 1.6.31 is not" in html


@given(st.text())
def test_a_fragment_is_the_anchor_once_it_is_decoded(case_id):
    link = fragment(case_anchor(case_id))
    assert link.isascii()
    assert link.isprintable()
    assert not set(link) & set(" #<>\"'[]")
    assert unquote(link) == case_anchor(case_id)


def test_the_anchor_of_a_case_depends_on_its_id_alone():
    assert fragment(case_anchor("slide-80[compensation=none]")) == "case-slide-80%5Bcompensation%3Dnone%5D"
