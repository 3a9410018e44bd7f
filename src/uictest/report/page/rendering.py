"""Render templates to pages: texts are escaped, scripts are permitted by digest, nothing is loaded."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

from jinja2 import DictLoader, Environment, StrictUndefined
from jinja2.bccache import Bucket, BytecodeCache, bc_magic
from markupsafe import Markup

from uictest.core import user_cache
from uictest.report.domain_wording import domain_notices, domain_sentences
from uictest.report.escaping import printable
from uictest.report.page.plotting_script import plotting_script, script_digest
from uictest.report.part_wording import slide_speed

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
    environment.globals |= {
        "domain_sentences": domain_sentences,
        "domain_notices": domain_notices,
        "slide_speed": slide_speed,
    }
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
