"""Render templates to pages: texts are escaped, scripts are permitted by their digest."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Callable
from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from jinja2 import DictLoader, Environment, StrictUndefined
from jinja2.bccache import Bucket, BytecodeCache, bc_magic
from markupsafe import Markup

from uictest.core import user_cache
from uictest.core.document import Tone
from uictest.report.car_wording import car_facts, implausible_sentences
from uictest.report.case_words import tone
from uictest.report.counts import counted, counted_in
from uictest.report.escaping import printable
from uictest.report.firmness_sentences import firmness_sentences, firmness_table
from uictest.report.part_wording import (
    base_word,
    changed_parameters,
    domain_sentences,
    notices,
    part_sentences,
    slide_speed,
)
from uictest.report.repeat_wording import any_repeated, stops_text
from uictest.report.train_wording import train_facts, train_text
from uictest.report.verdict_sentences import (
    listed,
    number,
    reading_sentences,
    reading_sources,
    statement_sentence,
)

_UPLOT: Final = MappingProxyType(
    {
        "uplot.iife.min.js": "2d27e8ad3d228164525ce213f9dc716f39b4e3aee0cc773fb3491c96cf4921a2",
        "uplot.min.css": "df630c6a8d6f8eeaff264b50f73ce5b114f646ffd9a0bb74f049b0a00135fa04",
    }
)
"""Files of uPlot 1.6.31 -> their SHA-256."""


@cache
def uplot() -> tuple[str, ...]:
    """Return the script and the style sheet of uPlot; nothing where they are missing, or not what they were.

    They are read from the package that carries them, which is not imported.
    """
    carrier = find_spec("youplot")
    if carrier is None or carrier.origin is None:
        return ()
    folder = Path(carrier.origin).parent / "vendor"
    try:
        files = {name: (folder / name).read_bytes() for name in _UPLOT}
    except OSError:
        return ()
    if any(hashlib.sha256(file).hexdigest() != _UPLOT[name] for name, file in files.items()):
        return ()
    # A browser turns every line end into a line feed before it takes the digest.
    return tuple(file.decode("utf-8").replace("\r\n", "\n") for file in files.values())


def script_digest(script: str) -> str:
    """Return the SHA-256 of a script in Base64."""
    return base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")


_SCRIPTS = (
    "elements",
    "verdict_table",
    "packed_lines",
    "appearance",
    "values",
    "viewer",
    "marks",
    "across",
    "panels",
    "loops",
    "csv",
    "readout",
    "moments",
    "stops",
    "comparison",
    "laid_over",
    "copying",
    "anchors",
)
"""Parts of the script of a page, in the order in which they run; they share one scope."""

_STYLES = (
    "base",
    "tables",
    "verdicts",
    "sweep",
    "stops",
    "drawings",
    "laid_over",
    "runs",
    "studies",
    "narrow",
    "print",
)
"""Parts of the style sheet; those for narrow windows and for paper change what stands before them."""


def badge_tone(word: str) -> Tone:
    """Return the tone of the badge of a word: no test, or not judged, is no failure."""
    return "odd" if word in ("invalid", "inconclusive") else tone(word)


_WORDS: Final[tuple[Callable[..., Any], ...]] = (
    *(
        badge_tone,
        base_word,
        changed_parameters,
        notices,
        domain_sentences,
        part_sentences,
        slide_speed,
    ),
    *(car_facts, implausible_sentences),
    *(counted, counted_in, listed, number, reading_sentences, reading_sources, statement_sentence, tone),
    *(any_repeated, stops_text),
    *(firmness_sentences, firmness_table, train_facts, train_text),
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
    page, (plotting, style) = _page_script(), (uplot() if with_plots else ()) or ("", "")
    return (
        _environment()
        .get_template(template)
        .render(
            style=Markup(style + _page_style() + _running_head(running_head)),
            script=Markup(page),
            plotting=Markup(plotting),
            policy=_policy(*(script_digest(each) for each in (plotting, page) if each)),
            **context,
        )
    )


_REFERENCE: Final = re.compile(r'{% (?:extends|import|include|from) "([^"]+)"')
"""What names another template in a template."""


def load_template(name: str) -> None:
    """Load a template and all that it refers to, and what all pages share: to render it takes less then."""
    for part in (uplot, _page_script, _page_style):
        part()
    names = [name]
    for each in names:
        _environment().get_template(each)
        named = dict.fromkeys(_REFERENCE.findall(_templates()[each]))
        names += [other for other in named if other not in names]


def _policy(*digests: str) -> str:
    """Return the content security policy: the scripts of these digests and no other, no network at all."""
    scripts = " ".join(f"'sha256-{each}'" for each in digests)
    return (
        f"default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )


@cache
def _templates() -> dict[str, str]:
    folder = resources.files(__package__) / "templates"
    return {file.name: file.read_text("utf-8") for file in folder.iterdir() if file.name.endswith(".j2")}


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=DictLoader(_templates()),
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
