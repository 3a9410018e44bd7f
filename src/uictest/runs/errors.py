"""What a user gave that cannot be used."""

from __future__ import annotations

from collections.abc import Sequence


class InvalidInputError(ValueError):
    """Arguments or files that cannot be used; each message says what is wrong and what to do instead.

    Args:
        messages: complete, in the words of any caller.
        arguments: those that the caller can change, by name; a command shows the options that set them.
    """

    def __init__(self, *messages: str, arguments: Sequence[str] = ()) -> None:
        self.messages = messages
        self.arguments = tuple(arguments)
        super().__init__(*messages)

    def __str__(self) -> str:
        return "\n".join(self.messages)
