"""All hard cases by name. `python tests/hard_cases/draw.py FOLDER` draws them; docs/hard-cases.md lists them."""

import broken_mesh_cases
import camera_cases
import light_cases
import material_cases
import mesh_cases
import refused_cases
from hard_case import Case

GROUPS: dict[str, list[Case]] = {
    "Size and place": mesh_cases.SIZES,
    "Open and seen edge-on": mesh_cases.OPEN,
    "Damaged meshes": broken_mesh_cases.DAMAGED,
    "Cameras": camera_cases.CAMERAS,
    "Picture sizes": camera_cases.PICTURES,
    "Materials": material_cases.MATERIALS,
    "Layers": material_cases.LAYERS,
    "Lights": light_cases.LIGHTS,
    "Refused": [*broken_mesh_cases.UNREADABLE, *refused_cases.REFUSALS],
}
CASES: dict[str, Case] = {case.name: case for group in GROUPS.values() for case in group}
DRAWN = {name: case for name, case in CASES.items() if not case.refused}
REFUSED = {name: case for name, case in CASES.items() if case.refused}
assert len(CASES) == sum(map(len, GROUPS.values())), "two cases share a name"
