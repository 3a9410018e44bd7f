"""Render templates to pages: texts are escaped, links encoded, scripts permitted by their digest."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable
from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final
from urllib.parse import quote

from jinja2 import DictLoader, Environment, StrictUndefined
from jinja2.bccache import Bucket, BytecodeCache, bc_magic
from markupsafe import Markup

from uictest.core import user_cache
from uictest.core.document import Tone
from uictest.report.case_conditions import (
    base_word,
    car_facts,
    changed_parameters,
    domain_sentences,
    implausible_sentences,
    notices,
    part_sentences,
    slide_speed,
    train_facts,
    train_text,
)
from uictest.report.robustness import any_repeated, firmness_sentences, stops_text, strongest_numbers_table
from uictest.report.verdict_sentences import reading_sentences, reading_sources, statement_sentence
from uictest.report.words import counted, counted_in, listed, number, printable, tone


def case_anchor(case_id: str) -> str:
    """Return the `id` of the element that shows a case, e.g. `case-slip-120[friction=0.09]`."""
    return f"case-{printable(case_id)}"


def series_anchor(series_id: str) -> str:
    """Return the `id` of the element that shows a series, e.g. `series-acceptance`."""
    return f"series-{printable(series_id)}"


def fragment(anchor: str) -> str:
    """Return an anchor as it stands after the `#` of a link: percent-encoded."""
    return quote(anchor, safe="")


def case_fragment(case_id: str) -> str:
    """Return the fragment, after the `#`, of a link to a case."""
    return fragment(case_anchor(case_id))


def series_fragment(series_id: str) -> str:
    """Return the fragment, after the `#`, of a link to a series."""
    return fragment(series_anchor(series_id))


def may_replace(path: Path, mark: str) -> bool:
    """Return whether a page may be written here: there is none yet, or one with this mark.

    A template writes the mark as the attribute `data-document`. Raises OSError.
    """
    if path.is_symlink():
        return False
    if not path.exists():
        return True
    return path.is_file() and f'data-document="{mark}"'.encode() in path.read_bytes()


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


_SCRIPTS: Final = (
    *("elements", "verdict_table", "samples", "appearance", "viewer", "marks", "across", "panels"),
    *("loops", "readout", "moments", "stops", "comparison", "laid_over", "links"),
)
"""Parts of the script of a page, in the order in which they run; they share one scope."""
_STYLES: Final = (
    *("base", "tables", "verdicts", "sweep", "stops", "drawings", "laid_over", "runs", "studies"),
    *("narrow", "print"),
)
"""Parts of the style sheet; those for narrow windows and for paper change what stands before them."""


def badge_tone(word: str) -> Tone:
    """Return the tone of the badge of a word: no test, or not judged, is not a failure."""
    return "odd" if word in ("invalid", "inconclusive") else tone(word)


_WORDS: Final[tuple[Callable[..., Any], ...]] = (
    *(badge_tone, tone, counted, counted_in, listed, number),
    *(base_word, changed_parameters, notices, domain_sentences, part_sentences, slide_speed),
    *(car_facts, implausible_sentences, train_facts, train_text),
    *(reading_sentences, reading_sources, statement_sentence),
    *(any_repeated, stops_text, firmness_sentences, strongest_numbers_table),
)
"""What every template can put results into words by."""


def render(template: str, *, with_plots: bool, running_head: str = "", **context: Any) -> str:
    """Return a template of this package filled in.

    Args:
        template: its name.
        with_plots: put the plotting script into the page.
        running_head: what stands at the head of every printed page, after the name of the program.
        context: what the template is filled in with.

    """
    plotting, plot_style = (uplot() if with_plots else ()) or ("", "")
    scripts = [script for script in (plotting, _page_script()) if script]
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    permitted = " ".join(f"'sha256-{digest}'" for digest in digests)
    policy = (
        f"default-src 'none'; script-src {permitted}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )
    return (
        _environment()
        .get_template(template)
        .render(
            style=Markup(plot_style + _page_style() + _running_head(running_head)),
            script=Markup(_page_script()),
            plotting=Markup(plotting),
            policy=policy,
            **context,
        )
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
    shown = f"uictest · {printable(text)}" if text else "uictest"
    escaped = "".join(letter if letter.isalnum() else f"\\{ord(letter):x} " for letter in shown)
    return f'@page {{ @top-left {{ content: "{escaped}"; }} }}\n'


def _own_text(folder: str, name: str) -> str:
    return (resources.files(__package__) / folder / name).read_text("utf-8")


class TemplateCache(BytecodeCache):
    """Keeps compiled templates in the user's cache, from one run to the next."""

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill the bucket of a template if its code is there."""
        code = user_cache.read("template", self._inputs(bucket))
        if code is not None:
            bucket.bytecode_from_string(code)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep the code of a template."""
        user_cache.write("template", self._inputs(bucket), bucket.bytecode_to_string())

    def _inputs(self, bucket: Bucket) -> bytes:
        return bc_magic + f"{bucket.key} {bucket.checksum}".encode()
