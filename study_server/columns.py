"""Every column of every exported table, described: the codebook."""

FIRST = "; of the first showing, also where a revision counts"

RATINGS = {
    "session": "public name of the session; one person's visit",
    "participant": "pseudonym of the person: the same for all sessions of one recruiting-service participant",
    "mode": "live, pilot, or simulated (answered by `fakesss simulate`)",
    "started_at": "when the participant agreed to take part, ISO 8601 UTC",
    "trial": "1, 2, ...: place of the picture in this session's order",
    "presentation": "1, 2, ...: which showing of this picture to this person (2: shown again for test-retest)",
    "stimulus": "id of the picture in stimuli.csv",
    "question": "name of the question in study.toml",
    "rating": "1 .. number of steps of the question; empty: not answered",
    "rt_ms": "milliseconds from the first frame with the picture to the (last) choice of this answer",
    "shown_at": "when the picture came on screen, ISO 8601 UTC, by the server's clock; of the answer in this row",
    "answered_at": "when the answer was chosen, ISO 8601 UTC, by the server's clock",
    "revision": "0: the first answer; n: the n-th different answer sent afterwards, which counts (earlier: events.csv)",
    "repeat_of": "id of the stimulus that this one shows again; empty otherwise",
    "check_expected": "the instructed answer, for an attention check; empty otherwise",
    "check_passed": "1 if the instructed answer was given, 0 if not; empty otherwise",
    "device_pixel_ratio": "device pixels per CSS pixel, zoom included" + FIRST,
    "zoom": "estimated page zoom, 1 = 100%" + FIRST,
    "drawn_width_px": "width of the picture on screen in device pixels; equals the file's width if it was not scaled"
    + FIRST,
    "window_width_px": "width of the browser's viewport, CSS pixels" + FIRST,
    "window_height_px": "height of the browser's viewport, CSS pixels" + FIRST,
    "focus_lost_ms": "milliseconds of the trial during which the page was hidden or not in front" + FIRST,
    "study_sha256": "SHA-256 of study.toml",
    "stimulus_sha256": "SHA-256 of the picture's file, checked in the browser before it was shown",
}

PARTICIPANTS = {
    "session": RATINGS["session"],
    "participant": RATINGS["participant"],
    "mode": RATINGS["mode"],
    "status": "finished (every rating stored), active, dropped (silent for longer than the study allows), screened-out "
    "(an answer about the person ended it), or withdrawn",
    "started_at": RATINGS["started_at"],
    "finished_at": "when the last expected rating was stored, ISO 8601 UTC; empty: not finished, or withdrawn",
    "last_seen_at": "when the participant last sent something, ISO 8601 UTC",
    "order_row": "1, 2, ...: row of the order design",
    "trials": "number of pictures to be rated",
    "trials_answered": "number of pictures rated",
    "ratings": "number of ratings stored",
    "checks_failed": "number of instructed items answered otherwise than asked, as answers now stand",
    "language": "language of the pages: en, de, es or fr",
    "comments": "what the participant wrote at the end",
    "study_sha256": RATINGS["study_sha256"],
}

CLIENT = {
    "address": "network address of the visitor; only if the study asks for it",
    "browser": "how the browser names itself; only if the study asks for it",
}

DISPLAYS = {
    "session": RATINGS["session"],
    "mode": RATINGS["mode"],
    "trial": RATINGS["trial"],
    "stimulus": RATINGS["stimulus"],
    "shown_at": "when the picture first came on screen, ISO 8601 UTC, by the server's clock",
    "device_pixel_ratio": "device pixels per CSS pixel, zoom included",
    "zoom": "estimated page zoom, 1 = 100%",
    "drawn_width_px": "width of the picture on screen, device pixels",
    "drawn_height_px": "height of the picture on screen, device pixels",
    "scaled": "1 if the picture was drawn in another size than its file's, 0 if pixel by pixel; empty: not told",
    "gamut": "the widest of srgb, p3 and rec2020 that the browser says the screen covers; empty: not told",
    "window_width_px": "width of the browser's viewport, CSS pixels",
    "window_height_px": "height of the browser's viewport, CSS pixels",
    "focus_lost_ms": "milliseconds of the trial during which the page was hidden or not in front",
}

EVENTS = {
    "session": RATINGS["session"],
    "mode": RATINGS["mode"],
    "at": "ISO 8601 UTC, by the server's clock",
    "kind": "started, finished, revised (an answer was changed) or refused (an answer was not stored)",
    "detail": "JSON: what exactly",
}

STIMULI = {
    "stimulus": "id of the picture",
    "file": "name of the file in the folder stimuli",
    "sha256": "SHA-256 of the file",
    "width": "pixels",
    "height": "pixels",
    "role": "factor, compare, control or repeat",
    "label": "the picture in words",
    "rows": "the factors whose comparison this picture belongs to, separated by |",
    "same_picture_as": "id of the earlier stimulus with the same picture; empty: none",
}

CODEBOOK = {"table": "file of the export", "column": "name of the column", "description": "what it holds"}
