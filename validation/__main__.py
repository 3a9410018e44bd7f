"""`python -m validation [SOURCE..]`: compare with public sources and write what was found."""

from __future__ import annotations

import argparse
import pkgutil
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Final

from studies.stop_runner import StopRunner
from validation import sources
from validation.pages import overview, page
from validation.source import Source, Validation

_FOLDER: Final = Path(__file__).parent


def find_sources() -> dict[str, Source]:
    """Return every source by its name."""
    modules = (
        import_module(f"{sources.__name__}.{each.name}") for each in pkgutil.iter_modules(sources.__path__)
    )
    return {module.SOURCE.name: module.SOURCE for module in modules}


def validate(selected: Sequence[Source], jobs: int = 1) -> list[Validation]:
    """Compare with every source."""
    stop_runner = StopRunner(jobs)
    return [Validation(source, source.run(stop_runner)) for source in selected]


def files(validations: Sequence[Validation]) -> Mapping[Path, str]:
    """Return the pages of the sources and their table, by path."""
    return {
        **{_FOLDER / f"{each.source.name}.md": page(each) for each in validations},
        _FOLDER / "README.md": overview(validations),
    }


def main(arguments: Sequence[str]) -> int:
    """Print the pages of the sources that are named; without a name, write all of them. Return 0."""
    known = find_sources()
    parser = argparse.ArgumentParser("python -m validation", description=__doc__)
    parser.add_argument(
        *("names",),
        metavar="SOURCE",
        nargs="*",
        help=f"print its page: {', '.join(known)} [default: write all]",
    )
    names = parser.parse_args(arguments).names
    if unknown := [name for name in names if name not in known]:
        parser.error(f"no source {', '.join(unknown)}; accepted: {', '.join(known)}")
    found = validate([known[name] for name in names] if names else list(known.values()))
    if names:
        print("\n".join(page(each) for each in found), end="")
    else:
        for path, text in files(found).items():
            path.write_text(text, "utf-8")
        print(overview(found), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
