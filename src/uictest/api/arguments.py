"""Arguments of the public functions, and `set` as the texts of `--set`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal
from numbers import Integral, Real
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal

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
    """Return the request to record cases, from samples per second. Raises ValueError."""
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
    command = [str(word) for word in words]
    for option, value in options.items():
        for stated in value if isinstance(value, list) else [value]:
            command += [] if stated is None else [option, str(stated)]
    return command


Assignments = Mapping[str, Any]
"""Dotted key -> value, or list of values for an axis."""
_ENCLOSED = ("[", "{", '"', "'", "range(")
"""How a text begins whose commas do not divide it."""


def override_texts(assignments: Assignments | None, repeat: int | None = None) -> list[str]:
    """Return `key=value` texts as `--set` takes them.

    Args:
        assignments: texts as in a scenario (`90 %`), numbers, booleans, None, mappings; a list of values is
            an axis. A list inside a list is a list value.
        repeat: stops of every case, 1 to 1000; None: as the scenarios say.

    Raises:
        TypeError: a value is of another type.
        ValueError: a number is not finite, a value nested too deeply, or `repeat` is out of its range.

    """
    try:
        texts = [f"{key}={_axis_text(key, value)}" for key, value in (assignments or {}).items()]
    except RecursionError:
        raise ValueError("set: a value is nested too deeply") from None
    if repeat is None:
        return texts
    if not _is_whole(repeat) or not 1 <= repeat <= 1000:
        raise ValueError(f"repeat is {repeat!r}, expected a whole number from 1 to 1000")
    return [*texts, f"repeat={int(repeat)}"]


def _axis_text(key: str, value: Any) -> str:
    listed = _value_list(value)
    if listed is None:
        # A text is taken as it would stand on the command line: `a,b` and `range(...)` are axes.
        return value if isinstance(value, str) else _flow_text(key, value)
    items = (_quoted_text(item) if isinstance(item, str) else _flow_text(key, item) for item in listed)
    return ",".join(items)


def _value_list(value: Any) -> Sequence[Any] | None:
    """Return a list, a tuple, a range, an array or a column as a list; None for anything else."""
    if isinstance(value, list | tuple | range):
        return value
    items = value.tolist() if hasattr(value, "tolist") else None
    return items if isinstance(items, list) else None


def _quoted_text(text: str) -> str:
    """Return a text as one value of an axis, in quotes where a comma in it would divide it."""
    divided = "," in text and not text.lstrip().startswith(_ENCLOSED)
    return json.dumps(text, ensure_ascii=False) if divided else text


def _flow_text(key: str, value: Any) -> str:
    """Return a value in YAML on one line. Raises TypeError, ValueError."""
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Decimal | Real):
        if not math.isfinite(value):
            raise ValueError(f"set: {key} is {value}, expected a finite number")
        return str(value) if isinstance(value, Decimal) else repr(float(value))
    if isinstance(value, PathLike):
        return Path(fspath(value)).as_posix()
    if isinstance(value, Mapping):
        items = ", ".join(f"{_flow_text(key, name)}: {_flow_text(key, item)}" for name, item in value.items())
        return f"{{{items}}}"
    if (listed := _value_list(value)) is not None:
        return f"[{', '.join(_flow_text(key, item) for item in listed)}]"
    if hasattr(value, "item"):
        return _flow_text(key, value.item())
    raise TypeError(f"set: {key} is a {type(value).__name__}; write a text, a number or a list of them")
