"""The HTML page: the sections in their order, framed by what stands first and what stands last."""

from collections.abc import Callable, Sequence

from analysis.evidence import Evidence
from analysis.families import deciding_words
from analysis.remarks import not_live
from analysis.results import METHODS
from analysis.script import SCRIPT, script_source
from analysis.section import TEMPLATES, Section
from analysis.sections.agreement import agreement
from analysis.sections.assumptions import assumptions
from analysis.sections.cues import cues
from analysis.sections.equivalence import equivalence
from analysis.sections.interactions import interactions
from analysis.sections.models import models
from analysis.sections.people import people
from analysis.sections.pictures import pictures
from analysis.sections.ratings import ratings
from analysis.sections.tests import tests
from analysis.sections.thesis import thesis
from analysis.sentences import apa_sentence, findings
from analysis.wording import counted

SECTIONS: tuple[Callable[[Evidence], Section | None], ...] = (
    people,
    pictures,
    ratings,
    tests,
    interactions,
    models,
    equivalence,
    cues,
    thesis,
    agreement,
    assumptions,
)
"""In the order of the page: who and what, what was found, what else it allows to say, how far to trust it."""


def sections_of(evidence: Evidence) -> list[Section]:
    """Every section that has something to say."""
    return [section for make in SECTIONS if (section := make(evidence)) is not None]


def render_page(evidence: Evidence, sections: Sequence[Section], said: Sequence[str], origin: dict[str, str]) -> str:
    """`index.html` as text. `said`: the warnings; `origin`: the session block."""
    study, plan, sample = evidence.study, evidence.plan, evidence.sample
    sentences = [apa_sentence(each, plan) for each in evidence.main if each.p is not None]
    return TEMPLATES.get_template("report.html").render(
        study=study,
        plan=plan,
        sample=sample,
        counted=counted,
        lead=lead(evidence),
        not_live=not_live(sample.everything),
        method=METHODS[sample.mode],
        findings=findings(study, evidence.main, plan),
        summary=[sentence for section in sections for sentence in section.summary],
        sections=sections,
        apa=[("", sentences), *((section.title, section.sentences) for section in sections)],
        remarks=said,
        tables=[name for section in sections for name, table in section.tables.items() if len(table.columns)],
        origin=origin,
        thumbnails={
            key: uri for section in sections for each in section.drawings for key, uri in each.pictures.items()
        },
        script=SCRIPT,
        script_source=script_source(),
    )


def lead(evidence: Evidence) -> str:
    """Who is analysed, and what it takes to be named below."""
    sample, alpha = evidence.sample, evidence.plan.alpha
    test = "repeated-measures ANOVA, Greenhouse–Geisser corrected" if sample.mode == "repeated" else "one-way ANOVA"
    test += f", {deciding_words(evidence.plan, evidence.main)}"
    return (
        f"{counted(sample.n_started, 'person').replace('persons', 'people')} started, {sample.n_completed} completed, "
        f"{sample.n_analysed} are analysed. An effect is named where p < {alpha:g} ({test}); the interval of each "
        f"difference allows for all pairs (Tukey).{fewer(evidence)}"
    )


def fewer(evidence: Evidence) -> str:
    """How many people the tests within people rest on, where some lack a rating; empty where nobody does."""
    sizes = [each.n[0] for each in evidence.main if each.mode == "repeated" and each.p is not None]
    if not sizes or min(sizes) == evidence.sample.n_analysed:
        return ""
    few, many = min(sizes), max(sizes)
    number = str(few) if few == many else f"{few} to {many}"
    return (
        f" Each test takes the people who rated all pictures that it compares: {number} of the "
        f"{evidence.sample.n_analysed}, as the others lack a rating."
    )
