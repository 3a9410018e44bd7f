from functools import partial
from pathlib import Path

from uictest.selftest.conformance import situations


def test_a_first_controller_is_checked_with_the_command_that_is_shown(call, monkeypatch):
    monkeypatch.setattr(situations, "anything", partial(situations.anything, cycles=300))
    answer = call("init", "controller", "--python", "wsp", code=0)
    [command] = [line.split() for line in answer.err.splitlines() if "controller check" in line]
    assert call(*command[1:]).code == 0


def test_a_controller_in_c_comes_with_its_header(call):
    assert call("init", "controller", "--c", "wsp").code == 0
    assert {path.name for path in Path("wsp").iterdir()} == {
        *("Makefile", "wsp.c", "uictest_controller.h", "my-wsp.yaml", "slip-120.yaml")
    }


def test_nothing_of_a_controller_is_overwritten(call):
    Path("wsp").mkdir()
    Path("wsp/my_wsp.py").write_text("mine")
    call("init", "controller", "--python", "wsp", code=4, says="already there: wsp/my_wsp.py")
    assert [path.name for path in Path("wsp").iterdir()] == ["my_wsp.py"]


def test_the_language_of_a_controller_must_be_chosen(call):
    assert call("init", "controller").code == 4
    assert call("init", "controller", "--python", "a", "--c", "b").code == 4
    assert call("init", "somewhere", "--c", "b").code == 4
    assert list(Path().iterdir()) == []
