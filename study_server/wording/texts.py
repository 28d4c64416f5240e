"""What participants read unless the study says otherwise. English here; locales/ holds the translations.

`N_` marks a text for the catalogues without translating it: which language is wanted is known only when a page is made.
"""


def N_(text: str) -> str:
    """`text` itself."""
    return text


CONSENT = (
    N_("In this study you will look at pictures of objects made by a computer and say how they look to you. "
       "There are no right or wrong answers."),
    N_("Taking part is voluntary. You may stop at any time by closing this page, without giving a reason, and you may "
       "have your answers deleted."),
    N_("We store your answers and the time they took, the size of your window and how large and in which colours your "
       "screen showed each picture."),
)  # fmt: skip
"""One paragraph each; what is stored besides follows from the settings and from who comes, as the next texts say."""

SCREEN = N_("Before the pictures come checks of your screen, which you may leave out. We store its size in pixels and "
            "the range of its colours, as your browser tells them.")  # fmt: skip
SCREEN_PARTS = {
    "card": N_(
        "If you measure your screen with a bank card, we store how large its pixels are, and nothing of the card."
    ),
    "wedge": N_("We store how well you can tell dark and bright patches apart on your screen."),
    "plates": N_("We also look at your colour vision: we store which numbers you read on coloured plates."),
}
EXTERNAL = N_("We store the names that the service which sent you here has for you, for this study and for your visit, "
              "so that you can be paid. In the tables of answers a pseudonym stands instead.")  # fmt: skip

STORED = {
    (): N_("We store neither your name nor your network address nor which browser you use."),
    ("address",): N_("We also store your network address, but not your name nor which browser you use."),
    ("browser",): N_("We also store which browser you use, but neither your name nor your network address."),
    ("address", "browser"): N_("We also store your network address and which browser you use, but not your name."),
}

NO_DATE = N_("No date is set on which your answers will be deleted.")

INSTRUCTIONS = (
    N_("You will see one picture at a time, with {questions} under it. Look at the picture as long as you like, then "
       "say how much you agree."),
    N_("Please sit as you usually do in front of your screen, and leave the page at its normal size (100% zoom)."),
    N_("You can answer with the mouse, by touch, or with the keys {keys}. When everything is answered, press Next or "
       "the Enter key. Answers are saved as you go: after an interruption, open this page again and you continue "
       "where you were."),
)  # fmt: skip

COMMENTS = N_("Is there anything you would like to tell us?")
THANKS = N_("Thank you! All your answers are saved.")
CHECK = N_("This is to see that you are reading: please choose {answer} here.")
LOW = N_("completely disagree")
HIGH = N_("completely agree")

AGE = N_("How old are you?")
AGES = (
    N_("under 18"), "18-24", "25-34", "35-44", "45-54", "55-64", N_("65 or older"), N_("rather not say"),
)  # fmt: skip
BACKGROUND = N_("How much do you work with pictures (art, photography, design, computer graphics)?")
BACKGROUNDS = (N_("not at all"), N_("as a hobby"), N_("as a student"), N_("as a professional"))
VISION = N_("How is your eyesight at the screen, with glasses or lenses if you wear them?")
VISIONS = (
    N_("normal"), N_("blurred or otherwise impaired"), N_("colour vision deficiency"), N_("rather not say"),
)  # fmt: skip

MODES = {"pilot": N_("pilot"), "simulated": N_("simulated")}
"""Said beside the study's name, unless it is live."""

OURS = frozenset(
    (
        *CONSENT,
        *INSTRUCTIONS,
        COMMENTS,
        THANKS,
        CHECK,
        LOW,
        HIGH,
        AGE,
        *AGES,
        BACKGROUND,
        *BACKGROUNDS,
        VISION,
        *VISIONS,
    )
)
"""What a study need not translate."""
