"""The HTML page: the sections in their order, framed by what stands first and what stands last."""

from collections.abc import Callable, Sequence

from analysis.evidence import Evidence
from analysis.remarks import not_live
from analysis.results import METHODS
from analysis.section import TEMPLATES, Section
from analysis.sections.agreement import agreement
from analysis.sections.people import people
from analysis.sections.pictures import pictures
from analysis.sections.ratings import ratings
from analysis.sections.tests import tests
from analysis.sections.thesis import thesis
from analysis.sentences import apa_sentence, findings

SECTIONS: tuple[Callable[[Evidence], Section | None], ...] = (people, pictures, ratings, thesis, tests, agreement)
"""In the order of the page."""


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
        not_live=not_live(sample.everything),
        method=METHODS[sample.mode],
        findings=findings(study, evidence.main, plan),
        summary=[sentence for section in sections for sentence in section.summary],
        sections=sections,
        apa=[*sentences, *(sentence for section in sections for sentence in section.sentences)],
        remarks=said,
        tables=[name for section in sections for name in section.tables],
        origin=origin,
    )
