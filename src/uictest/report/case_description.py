"""What a case was about, in the user's words: what a result alone does not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any


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

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form."""
        return asdict(self)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> CaseDescription:
        """Return the subject whose `to_dict` is `content`. Raises ValueError for anything else."""
        try:
            texts = (
                {str(key): str(text) for key, text in each.items()}
                for each in (content["settings"], content.get("recorded", {}))
            )
            return cls(str(content["title"]), tuple(map(str, content["tags"])), *texts)
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"not the subject of a case: {error}") from error
