"""Arguments that several of the public functions take."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from numbers import Integral
from os import PathLike
from pathlib import Path
from typing import Literal

from uictest import runs
from uictest.plans.scenario.yaml import suggestion
from uictest.running import campaign

PathName = str | PathLike[str]
Trusted = Iterable[PathName]
Record = Literal["failed", "all", "none"]
_LARGEST_SEED = 2**32 - 1


def as_paths(names: PathName | Iterable[PathName]) -> list[Path]:
    """Return one name or several as paths."""
    return [Path(names)] if isinstance(names, str | PathLike) else [Path(name) for name in names]


def checked_seed(seed: int | None) -> int | None:
    """Return a seed, None for that of each scenario. Raises ValueError."""
    if seed is None:
        return None
    if not _is_whole(seed) or not 0 <= seed <= _LARGEST_SEED:
        raise ValueError(f"seed is {seed!r}, expected a whole number from 0 to {_LARGEST_SEED}")
    return int(seed)


def _is_whole(number: object) -> bool:
    """Return whether this is a whole number, also one of numpy; a truth value is none."""
    return isinstance(number, Integral) and not isinstance(number, bool)


def thread_count(jobs: int | Literal["auto"]) -> int:
    """Return a number of threads; `auto` is one for each processor. Raises ValueError."""
    if jobs == "auto":
        return runs.available_processors()
    if isinstance(jobs, str) or not _is_whole(jobs) or jobs < 1:
        raise ValueError(f"jobs is {jobs!r}, expected a number of threads from 1 or 'auto'")
    return int(jobs)


def sample_interval(argument: str, rate: float) -> float:
    """Return the time between samples, s, from samples per second. Raises ValueError."""
    if not 1.0 <= rate <= 100e3:
        raise ValueError(f"{argument} is {rate!r}, expected 1 to 100000 samples per second")
    return 1.0 / rate


def recording_request(record: str, rate: float = 100.0) -> campaign.RecordingRequest:
    """Return which cases to record and how often, from samples per second. Raises ValueError."""
    accepted = ("failed", "all", "none")
    if record not in accepted:
        raise ValueError(f"record is {record!r}; {suggestion(str(record), accepted)}")
    return campaign.RecordingRequest(record, every=sample_interval("rate", rate))  # type: ignore[arg-type]  # as checked


@contextmanager
def expression_of(argument: str, text: str | None) -> Iterator[None]:
    """Let the error of a malformed expression name the argument."""
    try:
        yield
    except campaign.ExpressionError as error:
        raise ValueError(f"{argument}: {error} in {text!r}") from None


def command_words(words: Sequence[PathName], options: Mapping[str, object]) -> list[str]:
    """Return the arguments of the command that does the same, for the manifest.

    Args:
        words: the command and what it works on.
        options: option -> value, or several; None: the option is not there.
    """
    pairs = [
        (option, str(each))
        for option, value in options.items()
        for each in (value if isinstance(value, list) else [value])
        if each is not None
    ]
    return [*map(str, words), *(word for pair in pairs for word in pair)]
