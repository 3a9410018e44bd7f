"""How user text is worded in messages: safe for a terminal, short, with the nearest valid name."""

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Final

QUOTED_LENGTH: Final = 60
EXAMPLE_LENGTH: Final = 80


def visible(text: str) -> str:
    """``text`` with every character that a terminal would act on, or not show, written as an escape."""
    if text.isprintable():
        return text
    return "".join(char if char.isprintable() else _escape(char) for char in text)


def _escape(char: str) -> str:
    code = ord(char)
    if code <= 0xFF:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def quoted(text: str) -> str:
    """``text`` in single quotes, escaped and cut to a readable length."""
    short = text if len(text) <= QUOTED_LENGTH else text[: QUOTED_LENGTH - 3] + "..."
    return f"'{visible(short)}'"


def short_example(text: str) -> str:
    """Return the text, escaped; empty if it is too long for a hint, since half an example is wrong."""
    return visible(text) if len(text) <= EXAMPLE_LENGTH else ""


def nearest(text: str, valid: Iterable[str]) -> str | None:
    """The valid name that ``text`` was probably meant to be."""
    candidates = list(valid)
    matches = get_close_matches(
        text[:QUOTED_LENGTH].lower(), [name.lower() for name in candidates], n=1, cutoff=0.6
    )
    if not matches:
        return longer_name(text, candidates)
    return next(name for name in candidates if name.lower() == matches[0])


def longer_name(text: str, valid: Iterable[str]) -> str | None:
    """The one valid name of which ``text`` is a whole word: `initial_speed` for `speed`."""
    longer = [name for name in valid if text.lower() in name.lower().split("_")]
    return longer[0] if len(longer) == 1 else None


def suggestion(text: str, valid: Iterable[str]) -> str:
    """A hint that names the nearest valid name, or else lists what is accepted."""
    candidates = sorted(valid)
    guess = nearest(text, candidates)
    if guess is not None:
        return f"did you mean {quoted(guess)}?"
    return "accepted: " + ", ".join(candidates) if candidates else ""
