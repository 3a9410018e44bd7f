"""The error for arguments and files that cannot be used."""


class InvalidInputError(ValueError):
    """Arguments or files that cannot be used; each message says what is wrong and what to write instead."""

    def __init__(self, *messages: str) -> None:
        self.messages = messages
        super().__init__(*messages)

    def __str__(self) -> str:
        return "\n".join(self.messages)
