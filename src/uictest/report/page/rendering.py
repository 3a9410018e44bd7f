"""Templates become pages here: every text escaped, every script known by its digest, nothing loaded."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from uictest.report.escaping import printable
from uictest.report.page.plotting_script import digest, plotting_script

if TYPE_CHECKING:
    from jinja2 import Environment


def render(template: str, *, with_plots: bool, **context: Any) -> str:
    """Return a template of this package filled in; `with_plots` puts the plotting script into the page."""
    from markupsafe import Markup

    page, plotly = _own_text("page.js"), plotting_script() if with_plots else None
    return (
        _environment()
        .get_template(template)
        .render(
            style=Markup(_own_text("page.css")),
            script=Markup(page),
            plotly=Markup(plotly.packed) if plotly else "",
            policy=_policy(digest(page), *([plotly.digest] if plotly else [])),
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
    from jinja2 import DictLoader, Environment as JinjaEnvironment, StrictUndefined

    from uictest.report.page.template_cache import TemplateCache

    folder = resources.files(__package__) / "templates"
    sources = {file.name: file.read_text("utf-8") for file in folder.iterdir() if file.name.endswith(".j2")}
    environment = JinjaEnvironment(
        loader=DictLoader(sources),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_visible,
        bytecode_cache=TemplateCache(),
    )
    environment.filters["figure"] = _figure
    return environment


def _visible(value: Any) -> Any:
    # Escaping makes markup harmless; what could reverse the reading direction or hide is spelled out first.
    return printable(value) if type(value) is str and not value.isprintable() else value


def _figure(value: float | None, form: str = ".4g") -> str:
    return "–" if value is None or value != value else format(value, form)  # noqa: RUF001 - a dash on paper


def _own_text(name: str) -> str:
    return (resources.files(__package__) / "templates" / name).read_text("utf-8")
