"""The head of documents."""

import pytest

from uictest.core.envelope import MANIFEST, RESULT, head, is_of, is_old, require


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
def test_a_document_is_of_its_own_kind_only_and_one_of_0_2_is_not_read(schema, kind, old):
    assert not is_of({"schema": old}, schema, kind)
    assert is_old({"schema": old})
    written = head(schema, kind)
    assert not is_old(written)
    assert is_of(written, schema, kind)
    assert not is_of(written, schema, "comparison")
    assert not is_of(written, {RESULT: MANIFEST, MANIFEST: RESULT}[schema], kind)
    with pytest.raises(ValueError, match=rf"found schema '{old}', written by uictest 0.2 or older: run it"):
        require({"schema": old}, schema, kind)


def test_what_has_no_head_is_of_no_kind_and_the_error_says_what_was_expected_and_found():
    for document in (None, [], "text", {}, {"schema": []}, {"schema": RESULT}):
        assert not is_of(document, RESULT, "run")
    with pytest.raises(ValueError, match=r"expected schema .*result/2', kind 'run', found schema 'other/1'"):
        require({"schema": "other/1"}, RESULT, "run")
