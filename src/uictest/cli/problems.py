"""What the user can put right."""

from __future__ import annotations


class InvalidInputError(Exception):
    """Options or files that cannot be used; the message is complete and may have several lines."""
