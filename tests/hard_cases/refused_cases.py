"""Scenes that are refused."""

from hard_case import Case

REFUSALS = [
    Case(
        "field-of-view-180",
        "The tangent of its half is infinite.",
        "camera.field_of_view: 180.0: must be <= 170",
        changes={"camera.field_of_view": 180.0},
        refused=True,
    ),
    Case(
        "clip-planes-swapped",
        "Far before near.",
        "camera: near 5.0 must be < far 4.0",
        changes={"camera.near": 5.0, "camera.far": 4.0},
        refused=True,
    ),
    Case("no-pixels", "A picture 0 pixels wide.", "size[1]: 0: must be >= 1", changes={"size": (0, 64)}, refused=True),
    Case(
        "too-many-pixels",
        "Larger than this OpenGL's textures.",
        "lower size or supersampling",
        changes={"size": (16384, 16384), "supersampling": 8},
        refused=True,
    ),
    Case(
        "nan-weight",
        "TOML can say nan.",
        "material.backlight: nan: must be",
        changes={"material.backlight": float("nan")},
        refused=True,
    ),
    Case(
        "infinite-angle",
        "TOML can say inf.",
        "light.azimuth: inf: must be",
        changes={"light.azimuth": float("inf")},
        refused=True,
    ),
    Case(
        "negative-exponent",
        "Thin parts would be infinitely bright.",
        "material.thickness_exponent: -1.0: must be >= 0",
        changes={"material.thickness_exponent": -1.0},
        refused=True,
    ),
    Case(
        "weight-beyond-limit",
        "Products would leave float32.",
        "material.backlight: 2000000.0: must be <= 1000000",
        changes={"material.backlight": 2e6},
        refused=True,
    ),
]
