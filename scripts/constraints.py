"""Write the versions of all packages that a release was tested with, as constraints for pip.

    .venv/bin/python scripts/constraints.py

The environment in which the tests passed is read: what uictest needs with all of its extras but the tools of
development, and what those packages need. Only names and versions are written: no path, no host.
"""

import argparse
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

REPOSITORY = Path(__file__).parents[1]
CONSTRAINTS = REPOSITORY / "src" / "uictest" / "constraints.txt"
NO_EXTRAS = frozenset({"dev", "docs"})
"""Extras that no installation for use has."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the file into the package, or where `--output` says."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=CONSTRAINTS)
    chosen = parser.parse_args(arguments)
    chosen.output.write_text("".join(f"{line}\n" for line in constraints(needed())), encoding="utf-8")
    print(chosen.output)


def needed() -> list[Requirement]:
    """Return what the package needs, all extras of use included."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    listed = [
        *project["dependencies"],
        *(each for name in extras if name not in NO_EXTRAS for each in extras[name]),
    ]
    return [Requirement(each) for each in listed]


def constraints(requirements: Iterable[Requirement]) -> Iterator[str]:
    """Yield `name==version` for packages and all that they need, as installed here, sorted.

    Raises PackageNotFoundError for one that is missing: the tests did not pass here.
    """
    versions: dict[str, str] = {}
    waiting = list(requirements)
    while waiting:
        requirement = waiting.pop()
        name = canonicalize_name(requirement.name)
        if name in versions and not requirement.extras:
            continue
        package = metadata.distribution(name)
        versions[name] = package.version
        for text in package.requires or ():
            inner = Requirement(text)
            wanted = [{"extra": extra} for extra in ("", *requirement.extras)]
            if inner.marker is None or any(map(inner.marker.evaluate, wanted)):
                waiting.append(inner)
    yield from (f"{name}=={versions[name]}" for name in sorted(versions))


if __name__ == "__main__":
    main()
