import re

import pytest

import uictest


def test_the_version(call):
    assert call("--version").out == f"uictest {uictest.__version__}\n"


@pytest.mark.parametrize("option", ["-h", "--help"])
def test_help_names_commands_and_exit_codes(call, option):
    answer = call(option, code=0)
    for word in ("run", "check", "list", "schema", "init", "library", "5 nothing selected"):
        assert word in " ".join(answer.out.split())


@pytest.mark.parametrize("group", [[], ["library"], ["identify"]])
def test_without_a_command_the_help_is_shown_and_nothing_was_tested(call, group):
    answer = call(*group)
    assert (answer.code, answer.err) == (4, "")
    assert answer.out == call(*group, "--help").out


@pytest.mark.parametrize("arguments", [["fly"], ["run\x1b[2J"], ["--nonsense"], ["library", "fly"]])
def test_a_usage_error_exits_4_and_shows_the_way_to_help(call, arguments):
    answer = call(*arguments)
    assert (answer.code, answer.out) == (4, "")
    assert "--help" in answer.err
    assert "\x1b" not in answer.err


@pytest.mark.parametrize(
    ("arguments", "written"),
    [
        (["evaluate", "stop.csv", "--rail=wet"], "In place of --rail write: --set rail.condition=NAME"),
        (["identify", "air", "stop.csv", "--trust", "."], "UICTEST_TRUST=DIR"),
        (["export-rig", "stop.yaml", "-k", "dry"], "--case ID"),
    ],
)
def test_an_option_that_is_written_otherwise_is_refused_with_what_to_write(call, arguments, written):
    call(*arguments, code=4, says=written)


def test_an_option_that_a_command_never_had_shows_the_way_to_help(call):
    assert "--help" in call("open", "--rail=wet", code=4).err


@pytest.mark.parametrize("columns", ["40", "60", "80", "120"])
@pytest.mark.parametrize("group", [[], ["identify"], ["library"]])
def test_the_list_of_commands_holds_whole_sentences(call, monkeypatch, columns, group):
    monkeypatch.setenv("COLUMNS", columns)
    paragraphs = call(*group, "--help").out.split("\n\n")
    sections = [each for each in paragraphs if re.match(r"[A-Z][\w ]+:\n  [a-z]", each)]
    listed = [row for each in sections for row in re.split(r"\n  (?=[a-z])", each.rstrip())[1:]]
    assert listed
    assert [each for each in listed if not each.endswith(".") or each.endswith("...")] == []
