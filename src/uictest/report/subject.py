"""What a case was about, in the user's words: what a result alone does not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Subject:
    """Title, tags and main settings of a case; `settings` maps a key of the scenario to its text."""

    title: str = ""
    tags: tuple[str, ...] = ()
    settings: Mapping[str, str] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form."""
        return asdict(self)

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Subject:
        """Return the subject whose `to_dict` is `content`. Raises ValueError for anything else."""
        try:
            settings = {str(key): str(text) for key, text in content["settings"].items()}
            return cls(str(content["title"]), tuple(map(str, content["tags"])), settings)
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"not the subject of a case: {error}") from error
