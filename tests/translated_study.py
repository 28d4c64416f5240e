"""A study whose texts are there in all four languages, written in any one of them."""

from pathlib import Path
from typing import Any

from study_fixture import write_study

TEXTS = {
    "en": {
        "title": "Grey discs", "consent": "We show you discs.\n\nYou judge them.", "contact": "Lab, lab@example.org",
        "retention": "ten years", "comments": "Which disc did you like?", "thanks": "Goodbye.",
        "translucent": "The object looks translucent.", "realistic": "The object looks realistic.",
        "hand": "Which hand do you write with?", "left": "the left one", "right": "the right one", "job": "Your job",
    },
    "de": {
        "title": "Graue Scheiben", "consent": "Wir zeigen Ihnen Scheiben.\n\nSie beurteilen sie.",
        "contact": "Labor, lab@example.org", "retention": "zehn Jahre", "comments": "Welche Scheibe gefiel Ihnen?",
        "thanks": "Auf Wiedersehen.", "translucent": "Der Gegenstand wirkt durchscheinend.",
        "realistic": "Der Gegenstand wirkt echt.", "hand": "Mit welcher Hand schreiben Sie?", "left": "mit der linken",
        "right": "mit der rechten", "job": "Ihr Beruf",
    },
    "es": {
        "title": "Discos grises", "consent": "Le mostramos discos.\n\nUsted los juzga.",
        "contact": "Laboratorio, lab@example.org", "retention": "diez años", "comments": "¿Qué disco le gustó?",
        "thanks": "Hasta luego.", "translucent": "El objeto parece translúcido.",
        "realistic": "El objeto parece real.", "hand": "¿Con qué mano escribe?", "left": "con la izquierda",
        "right": "con la derecha", "job": "Su profesión",
    },
    "fr": {
        "title": "Disques gris", "consent": "Nous vous montrons des disques.\n\nVous les jugez.",
        "contact": "Laboratoire, lab@example.org", "retention": "dix ans",
        "comments": "Quel disque vous a plu\u202f?", "thanks": "Au revoir.",
        "translucent": "L’objet paraît translucide.", "realistic": "L’objet paraît réel.",
        "hand": "De quelle main écrivez-vous\u202f?", "left": "de la gauche", "right": "de la droite",
        "job": "Votre métier",
    },
}  # fmt: skip
NAMED = ("title", "consent", "contact", "retention", "comments", "thanks")


def tables(language: str, *others: str, **survey: Any) -> dict[str, Any]:
    """`question` and `survey` written in `language` and translated into `others`."""
    own = TEXTS[language]
    hand = {"name": "hand", "text": own["hand"], "choices": [own["left"], own["right"]], "required": True}
    return {
        "question": [{"name": name, "text": own[name]} for name in ("translucent", "realistic")],
        "survey": {
            **{key: own[key] for key in NAMED},
            "language": language,
            "translations": {other: translation(language, other) for other in others},
            "retention_until": "2036-12-31",
            "about": [hand, {"name": "job", "text": own["job"]}],
            **survey,
        },
    }


def translation(written: str, other: str) -> dict[str, str]:
    """[survey.translations.<other>] of a study written in another language."""
    return {key if key in NAMED else TEXTS[written][key]: text for key, text in TEXTS[other].items()}


def translated_study(folder: Path, language: str = "en", *others: str, **survey: Any) -> Path:
    """Built in `folder`, with three pictures."""
    return write_study(folder, size=200, **tables(language, *others, **survey))
