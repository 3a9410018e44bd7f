from __future__ import annotations

import pytest

from uictest.cli.compilation import announce_compilation


@pytest.mark.parametrize(
    ("warm", "quiet", "said"), [(False, False, True), (True, False, False), (False, True, False)]
)
def test_a_wait_is_announced_once_for_all_commands(
    capsys: pytest.CaptureFixture[str], warm: bool, quiet: bool, said: bool
) -> None:
    announce_compilation(warm=warm, quiet=quiet)
    shown = capsys.readouterr()
    assert shown.out == ""
    assert ("uictest: compiling the rig (once per installation" in shown.err) is said
