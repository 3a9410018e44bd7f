"""Register commands: the list of commands shows the whole first sentence of each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import typer

Function = TypeVar("Function", bound=Callable[..., Any])


def command(group: typer.Typer, name: str) -> Callable[[Function], Function]:
    """Return the decorator that makes a function a command of a group."""

    def add(function: Function) -> Function:
        return group.command(name, short_help=first_sentence(function.__doc__ or ""))(function)

    return add


def first_sentence(text: str) -> str:
    """Return the first sentence of a help text on one line; typer would cut it at the end of a line."""
    words = text.split()
    end = next((place for place, word in enumerate(words, start=1) if word.endswith(".")), len(words))
    return " ".join(words[:end])
