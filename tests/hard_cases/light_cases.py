"""Hard cases of lights."""

from hard_case import Case
from hard_meshes import obj, sheet

NONE = (0.0, 0.0, 0.0)

LIGHTS = [
    Case(
        "no-light",
        "Every intensity is 0.",
        "The backlight alone.",
        changes={"light.ambient": NONE, "light.diffuse": NONE, "light.specular": NONE},
    ),
    Case(
        "light-behind",
        "The light stands straight behind the object: the half vector vanishes.",
        "The backlight, and a lit rim.",
        changes={"light.azimuth": 190.0, "light.elevation": -8.0},
    ),
    Case("light-at-the-pole", "Straight from above.", "Lit from above.", changes={"light.elevation": 90.0}),
    Case(
        "light-at-the-surface",
        "The light touches the object, and its attenuation grows without bound there.",
        "Finite; white where it touches, and a warning.",
        changes={
            "object": "sphere:2000",
            "light.kind": "point",
            "light.azimuth": 0.0,
            "light.elevation": 8.0,
            "light.distance": 1.0,
            "light.attenuation": (0.0, 0.0, 1.0),
        },
    ),
    Case(
        "light-at-the-centre",
        "The light stands in the middle of the object.",
        "Lit where the surface faces inwards, so nowhere.",
        changes={"object": "sphere:2000", "light.kind": "point", "light.distance": 0.0},
    ),
    Case(
        "spot-of-0.1-degrees",
        "A cone narrower than a pixel.",
        "A lit speck.",
        changes={"light.kind": "spot", "light.cutoff": 0.1, "light.azimuth": 10.0, "light.elevation": 8.0},
    ),
    Case(
        "spot-of-90-degrees",
        "The linear fall-off divides by 1 - cos of the cut-off; the cone is a half space.",
        "Lit all over.",
        changes={"light.kind": "spot", "light.cutoff": 90.0, "light.falloff": "linear"},
    ),
    Case(
        "spot-exponent-10000",
        "A fall-off steeper than float32's exponents.",
        "A lit speck.",
        changes={"light.kind": "spot", "light.spot_exponent": 1e4, "light.azimuth": 10.0, "light.elevation": 8.0},
    ),
    Case(
        "32-lights",
        "As many as there can be, with the first one among them 31 times more.",
        "32 times the light.",
        changes={"lights": [{}] * 31},
    ),
    Case(
        "32-lights-of-all-kinds",
        "Point, spot and directional lights all around.",
        "Lit from all sides.",
        changes={
            "lights": [
                {"kind": kind, "azimuth": 12.0 * turn, "elevation": 60.0 - 4 * turn}
                for turn, kind in enumerate(["point", "spot", "directional"] * 10 + ["point"])
            ]
        },
    ),
    Case(
        "shadow-grazing",
        "Light along the surface: the slope-scaled bias grows without bound.",
        "Lit from the side, the far parts in shadow.",
        changes={"light.shadows": True, "light.azimuth": 100.0, "light.elevation": 0.0},
    ),
    Case(
        "smallest-shadow-map",
        "16 texels for the whole object.",
        "Coarse shadows.",
        changes={"light.shadows": True, "shadow.map_size": 16},
    ),
    Case(
        "shadow-from-within",
        "A point light among the parts of the object sees them on all sides.",
        "Lit from within.",
        changes={"light.shadows": True, "light.kind": "point", "light.distance": 0.0},
    ),
    Case(
        "shadow-from-the-surface",
        "The light stands in the nearest plane of its own shadow map.",
        "Finite; next to nothing is lit.",
        changes={
            "object": "sphere:2000",
            "light.shadows": True,
            "light.kind": "spot",
            "light.azimuth": 0.0,
            "light.elevation": 8.0,
            "light.distance": 1.0,
        },
    ),
    Case(
        "shadow-on-a-sheet",
        "The surface that casts the shadow is the one that it would fall on.",
        "A sheet without specks.",
        lambda: obj(sheet()),
        ".obj",
        {"light.shadows": True},
        closed=False,
    ),
]
