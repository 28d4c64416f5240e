"""Hard cases of materials and of what the backlight passes through."""

from hard_case import Case

NONE = (0.0, 0.0, 0.0)
MOST = (1e6, 1e6, 1e6)
ALL_LARGEST = {
    "exposure": 1e6,
    "material.diffuse": (1.0, 1.0, 1.0),
    "material.ambient": 1e6,
    "material.specular": 1e6,
    "material.backlight": 1e6,
    "material.diffuse_weight": 1e6,
    "material.diffuse_contribution": 1e6,
    "material.specular_contribution": 1e6,
    "light.ambient": MOST,
    "light.diffuse": MOST,
    "light.specular": MOST,
}

MATERIALS = [
    Case(
        "exponent-0",
        "0 to the power 0 is left to the driver by GLSL's pow.",
        "The backlight shines through everything.",
        changes={"material.thickness_exponent": 0.0},
    ),
    Case(
        "exponent-0.001",
        "All but exponent 0: only the thickest point is darker.",
        "The backlight shines through everything.",
        changes={"material.thickness_exponent": 1e-3},
    ),
    Case(
        "exponent-10000",
        "Only what is thinner than 1e-4 glows.",
        "A dark knot with a glowing outline.",
        changes={"material.thickness_exponent": 1e4},
    ),
    Case(
        "shininess-0",
        "A highlight of exponent 0 is everywhere that faces the light.",
        "Bright where lit.",
        changes={"material.shininess": 0.0},
    ),
    Case(
        "shininess-100000",
        "A highlight smaller than a pixel.",
        "Specks where a sample meets it.",
        changes={"material.shininess": 1e5},
    ),
    Case(
        "weights-0",
        "Nothing at all adds light.",
        "A black knot.",
        changes={
            "material.backlight": 0.0,
            "material.ambient": 0.0,
            "material.diffuse_contribution": 0.0,
            "material.specular_contribution": 0.0,
        },
    ),
    Case(
        "weights-negative",
        "Terms take light away; the picture goes below 0.",
        "Finite; black in the PNG.",
        changes={
            "material.backlight": -1.2,
            "material.diffuse_weight": -0.5,
            "material.diffuse_contribution": -1.0,
            "material.specular_contribution": -1.0,
        },
    ),
    Case(
        "weights-1e6",
        "Every weight, intensity and the exposure at 1e6: their product is 1e24.",
        "Finite; white in the PNG, and a warning.",
        changes=ALL_LARGEST,
    ),
    Case(
        "black-material",
        "No diffuse reflectance: only the highlight and the diffuse weight are left.",
        "A glowing grey outline.",
        changes={"material.diffuse": NONE},
    ),
    Case(
        "widest-blur",
        "Taps a quarter of the object apart: most of them hit the background.",
        "Finite; background taps do not count.",
        changes={"blur.step": 0.25, "blur.depth_range": 1.0},
    ),
    Case(
        "narrowest-blur",
        "A depth range of 1e-9: every neighbour's weight is 0.",
        "The exact layer.",
        changes={"blur.depth_range": 1e-9, "blur.step": 1e-9},
    ),
    Case(
        "as-published",
        "The flaws of the program of 2011, from a distance where its constants hurt most.",
        "Finite.",
        changes={"style": "as published", "camera.distance": 30.0, "camera.field_of_view": 4.0},
    ),
]

LAYERS = [
    Case(
        "total-path",
        "The sum of all intervals along the line of sight.",
        "Darker where the knot crosses itself.",
        changes={"material.thickness": "total-path"},
    ),
    Case(
        "bridged",
        "Parts one behind the other without a hard edge.",
        "Soft where the knot crosses itself.",
        changes={"material.thickness": "bridged"},
    ),
    Case(
        "local",
        "Thickness baked at the vertices.",
        "No edge from what lies behind.",
        changes={"material.thickness": "local"},
    ),
    Case(
        "four-face-layer",
        "A second layer from as few faces as there can be.",
        "Finite; an approximation.",
        changes={"layers.faces": 4},
    ),
    Case(
        "occlusion-of-one-pixel",
        "Samples around a pixel that has no neighbours.",
        "One colour.",
        changes={"occlusion.method": "screen-space", "size": (1, 1)},
    ),
]
