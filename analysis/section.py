"""A part of the report: what it puts on the page, and what it gives to the files beside it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from analysis.figures.style import Drawing
from analysis.sorting import sortable

TEMPLATES = Environment(
    loader=PackageLoader("analysis"), autoescape=select_autoescape(), undefined=StrictUndefined, trim_blocks=True,
    lstrip_blocks=True,
)  # fmt: skip
TEMPLATES.filters["sortable"] = sortable


@dataclass(frozen=True)
class Section:
    """One heading of the page.

    `tables`: written as tables/NAME.csv and, as records, into results.json. `summary`: sentences for the paragraph that
    stands first. `sentences`: to paste into a paper. `warnings`: what a reader must know before believing it.
    """

    anchor: str
    title: str
    body: Markup
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    drawings: tuple[Drawing, ...] = ()
    summary: tuple[str, ...] = ()
    sentences: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def rendered(template: str, **context: Any) -> Markup:
    """The section's template, `templates/sections/TEMPLATE.html`, filled in."""
    return Markup(TEMPLATES.get_template(f"sections/{template}.html").render(**context))
