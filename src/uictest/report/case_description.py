"""What a case was about, in the user's words: what a result alone does not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Final

from pydantic import ConfigDict, TypeAdapter

from uictest import evaluation
from uictest.evaluation import required


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


_SUBJECTS: Final = TypeAdapter(
    dict[str, Annotated[CaseDescription, required("title", "tags", "settings")]],
    config=ConfigDict(defer_build=True),
)


def subjects_form(subjects: Mapping[str, CaseDescription]) -> dict[str, Any]:
    """Return the JSON form of the subjects of cases, by the ids of the cases."""
    form: dict[str, Any] = evaluation.to_json_form(_SUBJECTS, subjects)
    return form


def read_subjects(document: Mapping[str, Any]) -> dict[str, CaseDescription]:
    """Return the subjects of the cases in a document; none where an earlier version wrote it.

    Raises ValueError where one lacks a field, or a field holds something else.
    """
    try:
        return evaluation.from_json_form(_SUBJECTS, document.get("subjects", {}), place="subjects")
    except ValueError as error:
        raise ValueError(f"not the subject of a case: {error}") from error
