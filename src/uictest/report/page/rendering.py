"""Render templates to pages: texts are escaped, scripts are permitted by digest, nothing is loaded."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

from jinja2 import DictLoader, Environment, StrictUndefined
from jinja2.bccache import Bucket, BytecodeCache, bc_magic
from markupsafe import Markup

from uictest import user_cache
from uictest.report.escaping import printable
from uictest.report.page.plotting_script import plotting_script, script_digest


def render(template: str, *, with_plots: bool, **context: Any) -> str:
    """Return a template of this package filled in; `with_plots` puts the plotting script into the page."""
    page, plotly = _own_text("page.js"), plotting_script() if with_plots else None
    return (
        _environment()
        .get_template(template)
        .render(
            style=Markup(_own_text("page.css")),
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
    return environment


def _visible(value: Any) -> Any:
    # Escaping makes markup harmless; what could reverse the reading direction or hide is spelled out first.
    return printable(value) if type(value) is str and not value.isprintable() else value


def _figure(value: float | None, form: str = ".4g") -> str:
    return "–" if value is None or value != value else format(value, form)  # noqa: RUF001 - a dash on paper


def _own_text(name: str) -> str:
    return (resources.files(__package__) / "templates" / name).read_text("utf-8")


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
