"""Parts of the library by name, and every number of a part with its source."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from uictest.plans.scenario.files import Files, Roots
from uictest.plans.scenario.part_keys import PART_KEYS, PART_KINDS
from uictest.plans.scenario.references import Parts, folder_of
from uictest.plans.scenario.yaml import (
    Document,
    Part,
    Place,
    Quantity,
    Scalar,
    Source,
    dotted,
    quantities_in,
    quoted,
    single_error,
)


class SourcedNumber(NamedTuple):
    """A number of a part: its dotted key, the quantity and its source (None for a user's own number)."""

    key: str
    quantity: Quantity
    source: Source | None


def load_part_file(path: Path, trusted: Sequence[Path] = ()) -> Part:
    """The part that a file describes, of any kind.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    files = Files(Roots.of([path], trusted))
    tree = files.at(path)
    schema = tree.get("schema")
    models = {f"uictest/{kind}/1": PART_KEYS[key].model for key, kind in PART_KINDS.items()}
    if not isinstance(schema, Scalar) or schema.text not in models:
        schema_text = quoted(schema.text) if isinstance(schema, Scalar) else "none"
        place = tree.place if schema is None else schema.place
        raise single_error(
            place, f"not a part: its schema is {schema_text}", "schema", f"accepted: {', '.join(models)}"
        )
    name = Scalar(path.name, path.name, Place(Document(str(path), path.parent, path.name)))
    part: Part = Parts(files).resolve(name, models[schema.text], ()).part
    return part


def load_part(reference: str) -> Part:
    """The library part called ``folder/name``, e.g. ``vehicles/intercity-180``.

    Raises ScenarioErrors when there is none, KeyError when there is no such folder.
    """
    folder, _, name = reference.partition("/")
    models = {folder_of(each.model): each.model for each in PART_KEYS.values()}
    if folder not in models:
        raise KeyError(folder)
    place = Place(Document(reference, Path(), reference), 1, len(folder) + 2)
    part: Part = Parts(Files()).resolve(Scalar(name, name, place), models[folder], (folder,)).part
    return part


def numbers(part: Part) -> Iterator[SourcedNumber]:
    """Yield every number of a part, in the order of its model."""
    for key, quantity in quantities_in(part):
        yield SourcedNumber(dotted(key), quantity, part.sources.get(quantity.source))
