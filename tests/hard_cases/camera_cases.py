"""Hard cases of cameras and picture sizes."""

from hard_case import Case

CAMERAS = [
    Case(
        "camera-inside",
        "The viewer stands in the object.",
        "The inner walls; what the near plane opens follows `open_surface`.",
        changes={"object": "sphere:2000", "camera.distance": 0.4},
    ),
    Case(
        "camera-at-the-centre",
        "The distance all but vanishes.",
        "The inner walls.",
        changes={"object": "sphere:2000", "camera.distance": 1e-9},
    ),
    Case(
        "camera-on-the-surface",
        "The viewer's eye touches the surface.",
        "The far wall through an open front.",
        changes={"object": "sphere:2000", "camera.distance": 1.0},
    ),
    Case(
        "camera-behind",
        "The object is seen from behind, with the light in front of it.",
        "The knot's back, lit by its rim.",
        changes={"camera.azimuth": 180.0},
    ),
    Case(
        "camera-at-the-pole",
        "Straight from above, where azimuth has no meaning of its own.",
        "The picture with the horizon level.",
        changes={"camera.elevation": 90.0},
    ),
    Case(
        "camera-far-away",
        "Ten thousand radii off: depths differ in their last digits.",
        "Thickness as from near.",
        changes={"camera.distance": 1e4, "camera.field_of_view": 1.0, "size": (512, 512), "supersampling": 1},
    ),
    Case(
        "wide-clip-planes",
        "Near and far planes 1e10 apart in ratio leave a depth buffer no step for the object.",
        "The picture that fitted planes give.",
        changes={"camera.near": 1e-6, "camera.far": 1e4},
    ),
    Case(
        "narrow-clip-planes",
        "A slice of 1/20 radius through the object.",
        "The slice, by `open_surface`.",
        changes={"camera.distance": 4.0, "camera.near": 4.0, "camera.far": 4.05},
    ),
    Case(
        "near-plane-cuts",
        "The near plane takes the front away.",
        "The inside, by `open_surface`.",
        changes={"camera.distance": 4.0, "camera.near": 4.0},
    ),
    Case(
        "far-plane-cuts",
        "The far plane takes the second layer away.",
        "Thickness by `open_surface`.",
        changes={"camera.distance": 4.0, "camera.far": 4.0},
    ),
    Case(
        "everything-clipped",
        "Both planes lie in front of the object.",
        "The background alone, and a warning.",
        changes={"camera.distance": 4.0, "camera.near": 1.0, "camera.far": 2.0},
        empty=True,
    ),
    Case(
        "narrowest-view",
        "A field of view of 1 degree: all but a parallel projection.",
        "The knot without perspective.",
        changes={"camera.field_of_view": 1.0},
    ),
    Case(
        "widest-view",
        "A field of view of 170 degrees.",
        "The knot, stretched at the border.",
        changes={"camera.field_of_view": 170.0},
    ),
    Case(
        "widest-view-from-near",
        "170 degrees just outside the sphere in a wide picture.",
        "Finite values up to the border.",
        changes={"camera.field_of_view": 170.0, "camera.distance": 1.0001, "size": (160, 40)},
    ),
]

PICTURES = [
    Case("one-pixel", "1 x 1: no pixel has a neighbour.", "One colour.", changes={"size": (1, 1)}),
    Case("one-row", "1 pixel high: the shorter side sees the whole object.", "A row.", changes={"size": (64, 1)}),
    Case("one-column", "1 pixel wide.", "A column.", changes={"size": (1, 64)}),
    Case("odd-size", "Neither side is even and they differ.", "The knot, not stretched.", changes={"size": (97, 61)}),
    Case(
        "wide-picture",
        "4096 pixels in a row.",
        "The knot in its middle.",
        changes={"size": (4096, 16), "supersampling": 1},
    ),
    Case(
        "tall-picture",
        "4096 pixels in a column. A test of its own draws 4096 x 4096.",
        "The knot in its middle.",
        changes={"size": (16, 4096), "supersampling": 1},
    ),
    Case("most-samples", "64 samples in a pixel.", "Smooth edges.", changes={"supersampling": 8, "size": (48, 48)}),
]
