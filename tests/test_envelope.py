"""The head of documents."""

import pytest

from uictest.core.envelope import MANIFEST, RESULT, head, is_of, is_old, require


@pytest.mark.parametrize("kind", ["run", "sweep", "validation"])
def test_a_document_is_of_its_own_kind_only(kind):
    assert is_of(head(RESULT, kind), RESULT, kind)
    assert not is_of(head(RESULT, kind), RESULT, "comparison")
    assert not is_of(head(RESULT, kind), MANIFEST, kind)


@pytest.mark.parametrize(
    ("schema", "kind", "old"),
    [
        (RESULT, "run", "uictest/result/1"),
        (RESULT, "sweep", "uictest/sweep-result/1"),
        (RESULT, "validation", "uictest/validation-result/1"),
        (MANIFEST, "run", "uictest/manifest/1"),
        (MANIFEST, "sweep", "uictest/sweep-manifest/1"),
    ],
)
def test_a_document_of_0_2_is_told_from_others_and_not_read(schema, kind, old):
    assert not is_of({"schema": old}, schema, kind)
    assert is_old({"schema": old})
    assert not is_old(head(schema, kind))
    with pytest.raises(ValueError, match=rf"found schema '{old}', written by uictest 0.2 or older: run it"):
        require({"schema": old}, schema, kind)


@pytest.mark.parametrize("document", [None, [], "text", {}, {"schema": []}, {"schema": RESULT}])
def test_what_has_no_head_is_of_no_kind(document):
    assert not is_of(document, RESULT, "run")


def test_the_error_says_what_was_expected_and_found():
    with pytest.raises(ValueError, match=r"expected schema .*result/2', kind 'run', found schema 'other/1'"):
        require({"schema": "other/1"}, RESULT, "run")
