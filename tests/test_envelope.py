"""The head of documents that are written, and what was written before."""

import pytest

from uictest.core.envelope import MANIFEST, RESULT, head, is_of, require


@pytest.mark.parametrize("kind", ["run", "sweep", "validation"])
def test_a_document_is_of_its_own_kind_only(kind):
    assert is_of(head(RESULT, kind), RESULT, kind)
    assert not is_of(head(RESULT, kind), RESULT, "comparison")
    assert not is_of(head(RESULT, kind), MANIFEST, kind)


@pytest.mark.parametrize(
    ("written", "schema", "kind"),
    [
        ("uictest/result/1", RESULT, "run"),
        ("uictest/sweep-result/1", RESULT, "sweep"),
        ("uictest/validation-result/1", RESULT, "validation"),
        ("uictest/manifest/1", MANIFEST, "run"),
        ("uictest/sweep-manifest/1", MANIFEST, "sweep"),
    ],
)
def test_what_0_2_wrote_is_read(written, schema, kind):
    assert is_of({"schema": written}, schema, kind)
    assert not is_of({"schema": written}, schema, "variants")


@pytest.mark.parametrize("document", [None, [], "text", {}, {"schema": []}, {"schema": RESULT}])
def test_what_has_no_head_is_of_no_kind(document):
    assert not is_of(document, RESULT, "run")


def test_the_error_says_what_was_expected_and_found():
    with pytest.raises(ValueError, match=r"expected schema .*result/2', kind 'run', found schema 'other/1'"):
        require({"schema": "other/1"}, RESULT, "run")
