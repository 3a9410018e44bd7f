"""Render templates to pages: texts are escaped, scripts are permitted by their digest."""

from __future__ import annotations

import base64
import hashlib
import zlib
from collections.abc import Callable
from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, NamedTuple

from jinja2 import DictLoader, Environment, StrictUndefined
from jinja2.bccache import Bucket, BytecodeCache, bc_magic
from markupsafe import Markup

from uictest.core import user_cache
from uictest.report.difference import side_text
from uictest.report.escaping import printable
from uictest.report.part_wording import (
    base_word,
    changed_parameters,
    domain_notices,
    domain_sentences,
    part_sentences,
    slide_speed,
)
from uictest.report.repeat_wording import any_repeated, stops_text
from uictest.report.verdict_sentences import (
    counted,
    counted_in,
    failing_first,
    listed,
    number,
    reading_sentences,
    reading_sources,
    tone,
    without_rig_that_holds,
)


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


_SCRIPTS = (
    "elements",
    "verdict_table",
    "plotting",
    "packed_lines",
    "appearance",
    "values",
    "marks",
    "bars",
    "panels",
    "loops",
    "csv",
    "cursor",
    "moments",
    "stops",
    "comparison",
    "laid_over",
    "copying",
    "history",
    "heat",
    "scatter",
    "anchors",
)
"""Parts of the script of a page, in the order in which they run; they share one scope."""

_STYLES = (
    "base",
    "tables",
    "verdicts",
    "sweep",
    "sweep_plots",
    "stops",
    "drawings",
    "laid_over",
    "history",
    "studies",
    "narrow",
    "print",
)
"""Parts of the style sheet; those for narrow windows and for paper change what stands before them."""


_WORDS: Final[tuple[Callable[..., Any], ...]] = (
    *(base_word, changed_parameters, domain_notices, domain_sentences, part_sentences, slide_speed),
    *(counted, counted_in, failing_first, listed, number, reading_sentences, reading_sources, tone),
    *(any_repeated, side_text, stops_text, without_rig_that_holds),
)
"""What every template can put results into words by."""


def render(template: str, *, with_plots: bool, running_head: str = "", **context: Any) -> str:
    """Return a template of this package filled in.

    Args:
        template: its name.
        with_plots: put the plotting script into the page.
        running_head: what stands at the head of every printed page, behind the name of the program.
        context: what the template is filled in with.

    """
    page, plotly = _page_script(), plotting_script() if with_plots else None
    return (
        _environment()
        .get_template(template)
        .render(
            style=Markup(_page_style() + _running_head(running_head)),
            script=Markup(page),
            plotly=Markup(plotly.packed) if plotly else "",
            policy=_policy(script_digest(page), *([plotly.digest] if plotly else [])),
            **context,
        )
    )


def _policy(*digests: str) -> str:
    """Return the content security policy: the scripts of these digests and no other, no network at all."""
    scripts = " ".join(f"'sha256-{each}'" for each in digests)
    return (
        f"default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )


@cache
def _environment() -> Environment:
    folder = resources.files(__package__) / "templates"
    sources = {file.name: file.read_text("utf-8") for file in folder.iterdir() if file.name.endswith(".j2")}
    environment = Environment(
        loader=DictLoader(sources),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_visible,
        bytecode_cache=TemplateCache(),
    )
    environment.filters["figure"] = _figure
    environment.globals |= {word.__name__: word for word in _WORDS}
    return environment


def _visible(value: Any) -> Any:
    # Escaping makes markup harmless; what could reverse the reading direction or hide is spelled out first.
    return printable(value) if type(value) is str and not value.isprintable() else value


def _figure(value: float | None, form: str = ".4g") -> str:
    return "–" if value is None or value != value else format(value, form)  # noqa: RUF001 - a dash on paper


@cache
def _page_script() -> str:
    parts = "\n".join(_own_text("scripts", f"{name}.js") for name in _SCRIPTS)
    return f'"use strict";\n(() => {{\n{parts}}})();\n'


@cache
def _page_style() -> str:
    return "\n".join(_own_text("styles", f"{name}.css") for name in _STYLES)


def _running_head(text: str) -> str:
    """Return the style of the head of printed pages; every character that could end the text is escaped."""
    shown = " · ".join(filter(None, ("uictest", printable(text))))
    escaped = "".join(each if each.isalnum() else f"\\{ord(each):x} " for each in shown)
    return f'@page {{ @top-left {{ content: "{escaped}"; }} }}\n'


def _own_text(folder: str, name: str) -> str:
    return (resources.files(__package__) / folder / name).read_text("utf-8")


class TemplateCache(BytecodeCache):
    """Keeps compiled templates in the user's cache, from one run to the next."""

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill the bucket of a template if its code is there."""
        code = user_cache.read("template", _inputs(bucket))
        if code is not None:
            bucket.bytecode_from_string(code)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep the code of a template."""
        user_cache.write("template", _inputs(bucket), bucket.bytecode_to_string())


def _inputs(bucket: Bucket) -> bytes:
    return bc_magic + f"{bucket.key} {bucket.checksum}".encode()
