"""What further lights and shadows cost: `python benchmarks/lights.py`.

Whole pictures, drawn in turn; the ratio of medians to one directional light without shadows.
"""

from typing import Any

from fakesss.bench import in_turn
from fakesss.renderer import shared_renderer
from fakesss.scene import Scene

REPEATS = 11
MANY = [{"azimuth": 30.0 * turn, "diffuse": (0.1, 0.1, 0.1)} for turn in range(31)]
CASES: dict[str, dict[str, Any]] = {
    "one directional light": {},
    "a point light": {"light.kind": "point"},
    "a spot": {"light.kind": "spot"},
    "four directional lights": {"lights": MANY[:3]},
    "thirty-two directional lights": {"lights": MANY},
    "shadows, hard": {"light.shadows": True, "shadow.filter": "hard"},
    "shadows, pcf": {"light.shadows": True, "shadow.filter": "pcf"},
    "shadows, disc": {"light.shadows": True, "shadow.filter": "disc"},
}


def main() -> None:
    """Print one line for each case."""
    renderer = shared_renderer()
    scenes = {name: Scene(object="figure:30000").replace(changes) for name, changes in CASES.items()}
    times = in_turn({name: lambda scene=scene: renderer.render(scene) for name, scene in scenes.items()}, REPEATS)
    plain = times["one directional light"]
    print(f"{renderer.gpu.renderer}; figure:30000, 512x512, 3x3 samples, medians of {REPEATS}")
    for name, ms in times.items():
        print(f"{name:32}{ms:8.1f} ms  {ms / plain:.2f}")


if __name__ == "__main__":
    main()
