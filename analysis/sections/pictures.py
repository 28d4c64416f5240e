"""What was shown: a thumbnail of every picture."""

from typing import Any

from analysis.evidence import Evidence
from analysis.figures.style import data_uri, thumbnail
from analysis.section import Section, rendered
from analysis.study import StudyInfo
from analysis.wording import level_text


def pictures(evidence: Evidence) -> Section:
    """Thumbnails with ids and labels."""
    return Section("pictures", "Pictures", rendered("pictures", pictures=shown(evidence.study)))


def shown(study: StudyInfo) -> list[dict[str, Any]]:
    """Thumbnail, id, label and levels of every listed picture."""
    return [
        {
            "id": picture.id,
            "label": picture.label,
            "role": picture.role,
            "levels": [(name, level_text(value)) for name, value in picture.levels],
            "same": picture.same_picture_as,
            "image": data_uri(thumbnail(picture.file, 192))
            if picture.file is not None and picture.file.is_file()
            else None,
        }
        for picture in study.pictures
    ]
