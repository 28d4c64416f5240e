"""What was shown: a thumbnail of every picture."""

from typing import Any

from analysis.evidence import Evidence
from analysis.figures.style import data_uri, thumbnail
from analysis.section import Section, rendered
from analysis.study import StudyInfo
from analysis.wording import level_text, true_minus

MANY = 60
"""More pictures are shown smaller, and folded."""


def pictures(evidence: Evidence) -> Section:
    """Thumbnails with ids and labels."""
    return Section("pictures", "Pictures", rendered("pictures", pictures=shown(evidence.study), many=MANY))


def shown(study: StudyInfo) -> list[dict[str, Any]]:
    """Thumbnail, id, label and levels of every listed picture."""
    side = 192 if len(study.pictures) <= MANY else 96
    return [
        {
            "id": picture.id,
            "label": picture.label,
            "role": picture.role,
            "levels": [(name, true_minus(level_text(value))) for name, value in picture.levels],
            "same": picture.same_picture_as,
            "image": data_uri(thumbnail(picture.file, side))
            if picture.file is not None and picture.file.is_file()
            else None,
        }
        for picture in study.pictures
    ]
