from urllib.parse import unquote

from hypothesis import given, strategies as st

from uictest.report.page.links import case_anchor, fragment


@given(st.text())
def test_a_fragment_is_the_anchor_once_it_is_decoded(case_id):
    link = fragment(case_anchor(case_id))
    assert link.isascii()
    assert link.isprintable()
    assert not set(link) & set(" #<>\"'[]")
    assert unquote(link) == case_anchor(case_id)


def test_the_anchor_of_a_case_depends_on_its_id_alone():
    assert fragment(case_anchor("slide-80[compensation=none]")) == "case-slide-80%5Bcompensation%3Dnone%5D"
