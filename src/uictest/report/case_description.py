"""What a case was about, in the user's words: what a result alone does not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class CaseDescription:
    """Title, tags and main settings of a case, name -> text.

    `settings` holds what a simulated stop was run with; of a recorded one it holds the conditions that it was
    judged by, and `recorded`, else empty, says where its samples come from.
    """

    title: str = ""
    tags: tuple[str, ...] = ()
    settings: Mapping[str, str] = field(default_factory=dict)
    recorded: Mapping[str, str] = field(default_factory=dict)
