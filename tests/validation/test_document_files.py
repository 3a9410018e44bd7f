"""Files that are no validation: rejected, and never waited for."""

import os

import pytest

from uictest.analysis.validation import read_validation


def test_a_pipe_is_not_waited_for(tmp_path):
    pipe = tmp_path / "validation.json"
    os.mkfifo(pipe)
    with pytest.raises(ValueError, match="no regular file"):
        read_validation(pipe)


def test_deep_nesting_is_rejected(tmp_path):
    path = tmp_path / "validation.json"
    path.write_text("[" * 1_000_000)
    with pytest.raises(ValueError, match="nested too deeply"):
        read_validation(path)
