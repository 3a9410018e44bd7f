import pytest
from jinja2 import DictLoader, Environment
from markupsafe import Markup

from uictest.report.page import rendering
from uictest.report.page.rendering import TemplateCache


def test_what_cannot_be_seen_is_spelled_out_and_markup_of_ours_is_left_alone():
    assert rendering._visible("a\u202eb\x00") == "a\\u202eb\\x00"
    ours = Markup("<b>\n</b>")
    assert rendering._visible(ours) is ours
    assert rendering._visible(3) == 3


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
