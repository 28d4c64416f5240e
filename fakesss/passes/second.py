"""Where the light of a pixel is taken to have entered the object: one of several layers, by what the scene says."""

from fakesss.calls import Setting, as_published, no_thickness
from fakesss.frame_graph import Choice
from fakesss.knob import Knob, culled, first_of, levels
from fakesss.passes.sparse import why_not_sparse

METHODS = levels("layers.method", ("auto", "peel"))
KNOBS = (
    Knob(
        name="layer method",
        levels=METHODS,
        reference=METHODS[0],
        error="single samples at triangles seen edge-on, where one sample is many depths",
        unused=first_of(no_thickness, as_published, culled("first_exit")),
    ),
)

EXITS = {"first-interval": "first_exit", "total-path": "path_exit", "bridged": "bridged_exit", "local": "local_exit"}


def first_exit(setting: Setting) -> Choice:
    """The end of the first interval: the nearest back face of a solid seen from outside, else by peeling."""
    every = setting.scene.layers.resolution
    if setting.published:
        return peeled('style is "as published"', "as published")
    if setting.scene.layers.method == "peel":
        return peeled('layers.method is "peel"')
    if not setting.outside_only:
        return peeled(hidden_back_faces(setting))
    why = "of a solid seen from outside, the nearest back face ends the first interval"
    if not_sparse := why_not_sparse(setting):
        return Choice("first_exit", "nearest_back", why, {"peeled": why, "upsampled_back": not_sparse})
    sparse = f"layers.resolution is {every}"
    return Choice("first_exit", "upsampled_back", f"{why}; {sparse}", {"peeled": why, "nearest_back": sparse})


def peeled(why: str, because: str = "") -> Choice:
    """The peel, and why not the nearest back face."""
    return Choice("first_exit", "peeled", because or why, {"nearest_back": why, "upsampled_back": why})


def hidden_back_faces(setting: Setting) -> str:
    """Why the nearest back face need not end the first interval."""
    return (
        "a clip plane or the camera may cut the object open, so front faces do not hide all back faces"
        if setting.view.clips_sphere
        else "the mesh is open or passes through itself, so front faces do not hide all back faces"
    )


def second(setting: Setting) -> Choice:
    """The second layer, real or as far behind the front as `material.thickness` says."""
    kind = setting.scene.material.thickness
    why = f'material.thickness is "{kind}"'
    others = {exit: why for name, exit in EXITS.items() if name != kind}
    return Choice("second", EXITS[kind], why, others)
