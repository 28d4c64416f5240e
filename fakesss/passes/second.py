"""Where the light of a pixel is taken to have entered the object: one of several layers, by what the scene says."""

from fakesss.calls import Setting, no_thickness
from fakesss.frame_graph import Choice
from fakesss.knob import Knob, culled, first_of, levels

METHODS = levels("layers.method", ("auto", "peel"))
KNOBS = (
    Knob(
        name="layer method",
        levels=METHODS,
        reference=METHODS[0],
        error="single samples at triangles seen edge-on, where one sample is many depths",
        unused=first_of(no_thickness, culled("first_exit")),
    ),
)

EXITS = {"first-interval": "first_exit", "total-path": "path_exit", "bridged": "bridged_exit", "local": "local_exit"}


def first_exit(setting: Setting) -> Choice:
    """The end of the first interval: the nearest back face of a solid seen from outside, else by peeling."""
    method, view = setting.scene.layers.method, setting.view
    if setting.published:
        return Choice("first_exit", "peeled", "as published", {"nearest_back": 'style is "as published"'})
    if method == "peel":
        return Choice("first_exit", "peeled", 'layers.method is "peel"', {"nearest_back": 'layers.method is "peel"'})
    if setting.outside_only:
        why = "of a solid seen from outside, the nearest back face ends the first interval"
        return Choice("first_exit", "nearest_back", why, {"peeled": why})
    why = (
        "a clip plane or the camera may cut the object open, so front faces do not hide all back faces"
        if view.clips_sphere
        else "the mesh is open or passes through itself, so front faces do not hide all back faces"
    )
    return Choice("first_exit", "peeled", why, {"nearest_back": why})


def second(setting: Setting) -> Choice:
    """The second layer, real or as far behind the front as `material.thickness` says."""
    kind = setting.scene.material.thickness
    why = f'material.thickness is "{kind}"'
    others = {exit: why for name, exit in EXITS.items() if name != kind}
    return Choice("second", EXITS[kind], why, others)
