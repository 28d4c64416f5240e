"""The HTML page: what the template needs, and nothing it has to work out."""

from collections.abc import Sequence
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from analysis.figures import Drawing, thumbnail_uri
from analysis.plan import AnalysisPlan, Exclusions
from analysis.remarks import agreement_of_tests, not_live
from analysis.results import METHODS, Analysed
from analysis.rows import level_text
from analysis.sample import Sample
from analysis.sentences import apa_sentence, findings
from analysis.study import StudyInfo
from analysis.tables import (
    SHOWN_LEVELS,
    Table,
    table_4_4,
    table_4_5,
    table_of_pairs,
    table_of_raters,
    table_of_retests,
    table_of_tests,
    tables_of_ranks,
)

TEMPLATES = Environment(
    loader=PackageLoader("analysis"), autoescape=select_autoescape(), undefined=StrictUndefined, trim_blocks=True,
    lstrip_blocks=True,
)  # fmt: skip


def render_page(
    study: StudyInfo,
    plan: AnalysisPlan,
    sample: Sample,
    found: Sequence[Analysed],
    raters: pd.DataFrame,
    retests: pd.DataFrame,
    said: Sequence[str],
    drawings: Sequence[Drawing],
    origin: dict[str, str],
) -> str:
    """`index.html` as text. `found`: the default mode's analyses, then the other's."""
    main = [each for each in found if each.mode == found[0].mode]
    other = [each for each in found if each.mode != found[0].mode]
    return TEMPLATES.get_template("report.html").render(
        study=study,
        plan=plan,
        sample=sample,
        not_live=not_live(sample.everything),
        rules=declared_rules(plan.exclude),
        method=METHODS[sample.mode],
        findings=findings(study, main, plan),
        thesis_tables=thesis_tables(main, other, plan),
        tests=table_of_tests(main),
        ranks=tables_of_ranks(main),
        agreement=agreement_of_tests(main, plan.alpha),
        pairs=table_of_pairs(main, plan.confidence),
        raters=table_of_raters(raters),
        retests=table_of_retests(retests),
        apa=[apa_sentence(each, plan) for each in main if each.p is not None],
        remarks=said,
        figures=[(drawing, Markup(drawing.inline)) for drawing in drawings],
        pictures=pictures(study),
        origin=origin,
    )


def thesis_tables(main: Sequence[Analysed], other: Sequence[Analysed], plan: AnalysisPlan) -> list[Table]:
    """Tables 4.4 and 4.5 in the design's mode, then in the other."""
    tables = []
    for part in (main, other):
        if part:
            tables.append(table_4_4(part, plan))
            tables += [table_4_5(each) for each in part if in_full(each)]
    return tables


def in_full(each: Analysed) -> bool:
    """Whether the comparison's pairs are few enough for a table on the page."""
    return each.row.kind != "factor" and each.tukey is not None and len(each.row.levels) <= SHOWN_LEVELS


def declared_rules(rules: Exclusions) -> list[str]:
    """The exclusion rules in words."""
    said = []
    if rules.failed_checks is not None:
        said.append(f"{rules.failed_checks} or more failed attention checks")
    if rules.median_rt_ms_below is not None:
        said.append(f"median answer time below {rules.median_rt_ms_below:g} ms")
    if rules.same_answer_share is not None:
        said.append(f"one answer in {rules.same_answer_share:.0%} or more of the ratings")
    return said


def pictures(study: StudyInfo) -> list[dict[str, Any]]:
    """Thumbnail, id, label and levels of every listed picture."""
    return [
        {
            "id": picture.id,
            "label": picture.label,
            "role": picture.role,
            "levels": [(name, level_text(value)) for name, value in picture.levels],
            "same": picture.same_picture_as,
            "image": thumbnail_uri(picture.file) if picture.file is not None and picture.file.is_file() else None,
        }
        for picture in study.pictures
    ]
