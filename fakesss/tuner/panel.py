"""The panel: every field of a scene, where it stands, and what its slider covers.

Symbols are those of equation 3.6 in Gascons, *Fast simulation of translucent objects* (2011); its terms are equations
3.7 to 3.10.
"""

from collections.abc import Iterator, Mapping

from fakesss.tuner.controls import Control, Group, Need

NEAR_ONLY = Need("light.kind", ("point", "spot"), "a directional light is infinitely far")
SPOT_ONLY = Need("light.kind", ("spot",), "only of a spot light")
DISC_ONLY = Need("shadow.filter", ("disc",), "only of the disc filter")
BAKED_ONLY = Need("occlusion.method", ("baked",), "only baked")
SCREEN_ONLY = Need("occlusion.method", ("screen-space",), "only in screen space")
LOCAL_ONLY = Need("material.thickness", ("local",), "only of local thickness")
OCCLUDED = Need("occlusion.enabled", (True,), "occlusion is off")
BLURRED = Need("blur.enabled", (True,), "blur is off")

LIGHTS = (
    Group(
        "Position",
        (
            Control("light.kind", "kind"),
            Control("light.azimuth", "azimuth", -180, 180, 1, unit="°"),
            Control("light.elevation", "elevation", -90, 90, 1, unit="°"),
            Control("light.distance", "distance", 0.5, 20, 0.1, log=True, unit="radii", needs=(NEAR_ONLY,)),
        ),
    ),
    Group(
        "Intensity",
        (
            Control("light.ambient", "ambient", 0, 1, symbol="Ia", equation="3.7"),
            Control("light.diffuse", "diffuse", 0, 2, symbol="Id", equation="3.8"),
            Control("light.specular", "specular", 0, 2, symbol="Is", equation="3.9"),
            Control(
                "light.attenuation",
                "attenuation",
                0,
                1,
                0.01,
                needs=(NEAR_ONLY,),
                parts=("constant", "linear", "square"),
            ),
        ),
    ),
    Group(
        "Spot",
        (
            Control("light.cutoff", "cut-off", 1, 90, 0.5, unit="°", needs=(SPOT_ONLY,)),
            Control("light.falloff", "fall-off", needs=(SPOT_ONLY,)),
            Control(
                "light.spot_exponent",
                "exponent",
                0,
                64,
                0.5,
                symbol="e",
                needs=(SPOT_ONLY, Need("light.falloff", ("exponent",), "only of the exponent fall-off")),
            ),
        ),
    ),
    Group(
        "Shadow",
        (Control("light.shadows", "casts shadows"),),
    ),
    Group(
        "Shadow maps of all lights",
        (
            Control("shadow.map_size", "map size", 64, 4096, 64, log=True, unit="texels"),
            Control("shadow.filter", "filter"),
            Control("shadow.samples", "samples", 1, 64, 1, needs=(DISC_ONLY,)),
            Control("shadow.radius", "penumbra", 0.001, 0.1, 0.001, log=True, unit="diameters", needs=(DISC_ONLY,)),
            Control("shadow.bias", "bias", 0, 0.02, 0.0005, unit="diameters"),
        ),
    ),
)

MATERIAL = (
    Group(
        "Colour",
        (Control("material.diffuse", "diffuse colour", symbol="Kd", equation="3.6"),),
    ),
    Group(
        "Light from behind",
        (
            Control("material.backlight", "backlight", 0, 3, 0.05, symbol="wb", equation="3.10"),
            Control("material.thickness_exponent", "thickness exponent", 0, 60, 0.5, symbol="r", equation="3.10"),
            Control("material.diffuse_weight", "diffuse weight", 0, 1, 0.01, symbol="Kb", equation="3.10"),
            Control("material.thickness", "thickness", symbol="t", equation="3.10"),
            Control(
                "layers.gap",
                "gap width",
                0.001,
                1,
                0.001,
                log=True,
                unit="diameters",
                needs=(Need("material.thickness", ("bridged",), "only of bridged thickness"),),
            ),
            Control("layers.rays", "rays a vertex", 16, 4096, 16, log=True, needs=(LOCAL_ONLY,)),
            Control("layers.reach", "reach of rays", 0.01, 1, 0.01, unit="diameters", needs=(LOCAL_ONLY,)),
            Control("open_surface", "open surface"),
        ),
    ),
    Group(
        "Light from the front",
        (
            Control("material.ambient", "ambient", 0, 2, 0.01, symbol="ka", equation="3.7"),
            Control("material.diffuse_contribution", "diffuse contribution", 0, 1, 0.01, symbol="wd", equation="3.8"),
            Control("material.specular", "specular", 0, 2, 0.01, symbol="ks", equation="3.9"),
            Control("material.specular_contribution", "specular contribution", 0, 2, 0.01, symbol="ws", equation="3.9"),
            Control("material.shininess", "shininess", 1, 1000, 1, log=True, symbol="n", equation="3.9"),
        ),
    ),
)

CAMERA = (
    Group(
        "Orbit",
        (
            Control("camera.azimuth", "azimuth", -180, 180, 1, unit="°"),
            Control("camera.elevation", "elevation", -90, 90, 1, unit="°"),
            Control("camera.distance", "distance", 1.1, 20, 0.1, log=True, unit="radii"),
        ),
    ),
    Group(
        "Lens",
        (
            Control("camera.field_of_view", "field of view", 5, 120, 1, unit="°"),
            Control("camera.near", "near plane", 0.01, 20, 0.01, log=True, unit="radii"),
            Control("camera.far", "far plane", 0.1, 40, 0.01, log=True, unit="radii"),
        ),
    ),
)

SHADER = (
    Group(
        "Quality",
        (
            Control("quality", "preset"),
            Control("supersampling", "supersampling", 1, 8, 1),
            Control("style", "style"),
        ),
    ),
    Group(
        "Blur",
        (
            Control("blur.enabled", "blur"),
            Control("blur.step", "step", 0.0005, 0.05, 0.0005, log=True, unit="diameters", needs=(BLURRED,)),
            Control("blur.kernel", "kernel", needs=(BLURRED,)),
            Control("blur.depth_range", "depth range", 0.005, 1, 0.005, log=True, unit="diameters", needs=(BLURRED,)),
        ),
    ),
    Group(
        "Ambient occlusion",
        (
            Control("occlusion.enabled", "occlusion", symbol="a", equation="3.7"),
            Control("occlusion.method", "method", needs=(OCCLUDED,)),
            Control("occlusion.rays", "rays a vertex", 16, 16384, 16, log=True, needs=(OCCLUDED, BAKED_ONLY)),
            Control("occlusion.sampling", "sampling", needs=(OCCLUDED, BAKED_ONLY)),
            Control("occlusion.samples", "samples a pixel", 4, 256, 4, needs=(OCCLUDED, SCREEN_ONLY)),
            Control("occlusion.radius", "radius", 0.01, 1, 0.01, unit="diameters", needs=(OCCLUDED, SCREEN_ONLY)),
            Control("occlusion.bias", "bias", 0, 0.02, 0.0005, unit="diameters", needs=(OCCLUDED, SCREEN_ONLY)),
        ),
    ),
    Group(
        "Second layer",
        (
            Control("layers.method", "method"),
            Control("layers.faces", "faces", 500, 240_000, 500, log=True),
            Control("layers.resolution", "every n-th sample"),
            Control("layers.depth", "numbers"),
        ),
    ),
    Group(
        "Picture",
        (
            Control("size", "size", 64, 1024, 16, unit="pixels", parts=("width", "height")),
            Control("exposure", "exposure", 0.1, 4, 0.05, log=True),
            Control("background", "background", 0, 1),
            Control("alpha", "no background"),
        ),
    ),
)

GROUPS: Mapping[str, tuple[Group, ...]] = {"lights": LIGHTS, "material": MATERIAL, "camera": CAMERA, "shader": SHADER}

NO_CONTROL: Mapping[str, str] = {
    "object": "chosen from a list, a file or by dropping one: static/objects.js",
    "lights": "one at a time, with the controls of `light`: static/lights.js",
}

EFFECTS: Mapping[str, str] = {
    "backlight": "backlight",
    "blur": "blur",
    "occlusion": "ambient occlusion",
    "diffuse": "diffuse term",
    "specular": "specular term",
    "shadows": "shadows",
}


def controls() -> Iterator[Control]:
    """All of them, in the panel's order."""
    for groups in GROUPS.values():
        for group in groups:
            yield from group.controls
