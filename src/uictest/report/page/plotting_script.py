"""The plotting script of the pages: read from the installed package, packed once and cached."""

from __future__ import annotations

import base64
import hashlib
import zlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from uictest.core import user_cache


class PackedScript(NamedTuple):
    """A script as a page holds it.

    Args:
        digest: SHA-256 of the script itself, Base64, by which a browser permits it.
        packed: the script deflated, in Base64: less than half as long.

    """

    digest: str
    packed: str


@cache
def plotting_script() -> PackedScript:
    """Return plotly's script. Raises ModuleNotFoundError where plotly is not installed."""
    source = _source()
    status = source.stat()
    inputs = f"{source} {status.st_size} {status.st_mtime_ns}".encode()
    kept = user_cache.read("plotly", inputs)
    if kept is not None:
        return PackedScript(*kept.decode("ascii").split())
    # Reading turns every line end into a line feed, as a browser does before it takes the digest.
    script = packed_script(source.read_text("utf-8"))
    user_cache.write("plotly", inputs, "\n".join(script).encode("ascii"))
    return script


def packed_script(script: str) -> PackedScript:
    """Return a script with its digest, packed. For plotly's script this takes as long as ten stops."""
    text = script.encode("utf-8")
    return PackedScript(script_digest(script), base64.b64encode(zlib.compress(text, 9)).decode("ascii"))


def script_digest(script: str) -> str:
    """Return the SHA-256 of a script in Base64."""
    return base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")


def _source() -> Path:
    # The package is not imported: that takes a second.
    package = find_spec("plotly")
    if package is None or package.origin is None:
        raise ModuleNotFoundError("plotly is not installed, and the page needs its script", name="plotly")
    return Path(package.origin).parent / "package_data" / "plotly.min.js"
