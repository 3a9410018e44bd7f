"""Every command line that a page shows can be typed, and every command and option is described."""

import re
import shlex
from pathlib import Path

import pytest
import typer

from uictest.cli.entry import application

REPOSITORY = Path(__file__).parents[2]
_CODE = re.compile(r"^```[^\n]*\n(.*?)^```|((?:^    \S[^\n]*\n)+)", re.MULTILINE | re.DOTALL)
_CALL = re.compile(r"^\s*(?:\$ |- (?:run: )?|entry: |sh '|srun )?(?:[\w./-]*/)?uictest (\S.*)$")
_END_OF_CALL = re.compile(r" \| |; | > | 2>| &&|  #|(?<!\])' *$|\\$| &$")
_IN_PROSE = re.compile(r"`uictest ([^`]*)`")


def leaves(command, name=""):
    """Yield every command by the words that call it."""
    inner = getattr(command, "commands", None)
    if inner is None:
        yield name, command
        return
    for word, each in inner.items():
        yield from leaves(each, f"{name} {word}".strip())


COMMANDS = dict(leaves(typer.main.get_command(application())))


def calls(text):
    """Yield the arguments of every call of uictest in the code of a page."""
    for match in _CODE.finditer(text):
        for line in "".join(group or "" for group in match.groups()).splitlines():
            call = _CALL.match(line)
            if call and not call[1].startswith("["):
                yield _END_OF_CALL.split(call[1])[0]


def command_of(arguments):
    words = shlex.split(arguments)
    count = 2 if " ".join(words[:2]) in COMMANDS else 1
    return " ".join(words[:count]), words[count:]


def options_of(name):
    return {option for parameter in COMMANDS[name].params for option in parameter.opts} | {"-h", "--help"}


def test_every_call_can_be_parsed(page):
    for arguments in calls(page.read_text("utf-8")):
        name, rest = command_of(arguments)
        assert name in COMMANDS, arguments
        if not {"-h", "--help"} & set(rest):
            COMMANDS[name].make_context(name, rest)


def test_every_command_named_in_prose_exists_with_its_options(page):
    groups = {name.split()[0] for name in COMMANDS}
    for arguments in _IN_PROSE.findall(page.read_text("utf-8")):
        name, rest = command_of(arguments)
        assert name in COMMANDS or name in groups, arguments
        assert {word for word in rest if word.startswith("-")} <= options_of(name) | {"-"}, arguments


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_stands_on_the_page_of_commands(name):
    text = (REPOSITORY / "docs" / "commands.md").read_text("utf-8")
    assert re.search(rf"`(?:{name}|{name.split()[0]})`", text)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_says_in_the_help_what_it_does(name):
    """The pages show no help of a command: it has to be enough."""
    options = [each for each in COMMANDS[name].params if each.param_type_name == "option"]
    assert [each.name for each in options if not each.help] == []
    shown = COMMANDS[name].get_help(COMMANDS[name].make_context(name, [], resilient_parsing=True))
    assert {option for each in options for option in each.opts if option not in shown} == set()
