"""What every light that casts shadows sees of the object, all maps in one texture."""

from collections.abc import Hashable, Mapping
from typing import Any

from fakesss.calls import Setting, shining
from fakesss.frame import Frame
from fakesss.frame_graph import Pass, TextureSpec
from fakesss.knob import Knob, culled, first_of, levels, spread_order
from fakesss.lights import Light
from fakesss.passes.geometry import Cull, draw_mesh
from fakesss.passes.lights import array
from fakesss.scene import Scene
from fakesss.shadow_maps import Atlas, atlas, is_outside, map_views

MAPS = levels("shadow.map_size", (256, 512, 1024, 2048, 4096))
FILTERED = levels("shadow.filter", ("hard", "pcf"))
TAPS = levels("shadow.samples", (1, 2, 4, 8, 16, 32, 64))
KNOBS = (
    Knob(
        name="shadow map size",
        levels=MAPS,
        reference=MAPS[-1],
        error="where a shadow's edge runs, by parts of a texel",
        unused=culled("shadow"),
        order=1.0,  # an edge is off by parts of a texel
    ),
    Knob(
        name="shadow filter",
        levels=FILTERED,
        reference=FILTERED[-1],
        error="steps of a texel along a shadow's edge",
        unused=first_of(culled("shadow"), lambda scene: other_filter(scene, disc=False)),
    ),
    Knob(
        name="shadow taps",
        levels=TAPS,
        reference=TAPS[-1],
        error="grain in the penumbra",
        unused=first_of(culled("shadow"), lambda scene: other_filter(scene, disc=True)),
        order=spread_order(2),  # places on the disc
    ),
)

NOTHING = 1e9  # depth where a light sees nothing of the object, sphere radii: behind everything
FILTERS = {"hard": 0, "pcf": 1, "disc": 2}


def other_filter(scene: Scene, disc: bool) -> str:
    """Why a knob of the disc filter, or of the two others, is none of the scene's."""
    return "" if (scene.shadow.filter == "disc") == disc else f'shadow.filter is "{scene.shadow.filter}"'


def layout_of(setting: Setting) -> Atlas:
    """Where the maps stand; those of lights that are forced in do not make the others smaller."""
    scene = setting.scene
    side = atlas([light for light in shining(scene) if light.shadows], scene.shadow.map_size, scene.size).side
    return atlas(setting.casting, side, scene.size)


def faces_of(light: Light, setting: Setting) -> Cull:
    """Which faces need not be drawn: a light outside a solid sees none from behind."""
    return "back" if setting.solid and is_outside(light) else ""


def shadow(setting: Setting) -> Pass:
    """Reads `mesh`; writes `shadow_maps` (linear depth from each light, see shadow_maps.py).

    A sweep that moves neither object, camera nor light draws them once.
    """
    layout = layout_of(setting)
    maps = [
        (seen.uniforms, faces_of(light, setting))
        for light in setting.casting
        for seen in map_views(light, setting.view)
    ]

    def draw(frame: Frame) -> None:
        for number, (uniforms, cull) in enumerate(maps):
            frame.target.viewport = (*layout.corner(number), layout.side, layout.side)
            program = frame.program("shadow.vert", "shadow.frag", uniforms, {})
            draw_mesh(frame, frame.inputs["mesh"], setting.view, program, [], cull)
        frame.target.viewport = (0, 0, *layout.size)  # the target is used again

    def key(inputs: Mapping[str, Any]) -> Hashable:
        seen = tuple((*uniforms.values(), cull) for uniforms, cull in maps)
        return inputs["mesh"].sha256, setting.view.pose, layout, seen

    return Pass(
        "shadow",
        draw,
        reads=("mesh",),
        writes={"shadow_maps": TextureSpec(layout.size, 1)},
        depth_test=True,
        clear=(NOTHING, 0.0, 0.0, 0.0),
        key=key,
    )


def not_read(setting: Setting) -> dict[str, str]:
    """Why the lights need no shadow maps, or nothing if they do."""
    lacking = setting.lacking("shadows")
    return {"shadow_maps": lacking} if lacking else {}


def shadow_uniforms(setting: Setting) -> dict[str, Any]:
    """Those of `glsl/common_shadow.glsl`."""
    settings, layout = setting.scene.shadow, layout_of(setting)
    turns, maps, cubes, first = [], [], [], 0
    for light in setting.shining:
        seen = map_views(light, setting.view)
        turns.append(tuple(seen[0].turn.T.ravel()))
        maps.append((first if light in setting.casting else -1, *seen[0].width, seen[0].half_width))
        cubes.append(seen[0].centre[2] if len(seen) > 1 else -1.0)
        first += len(seen) if light.shadows else 0
    disc = {"shadow_radius": 2 * settings.radius} if settings.filter == "disc" else {}
    arrays = {"shadow_turn": array(turns), "shadow_map": array(maps), "shadow_cube": array(cubes)}
    return {**arrays, "map_side": layout.side, "shadow_bias": 2 * settings.bias, **disc}


def shadow_defines(setting: Setting) -> dict[str, int]:
    """The permutation that reads the maps."""
    filtering = FILTERS[setting.scene.shadow.filter]
    samples = {"SHADOW_SAMPLES": setting.scene.shadow.samples} if filtering == FILTERS["disc"] else {}
    return {"SHADOW_LIGHTS": len(setting.shining), "SHADOW_FILTER": filtering, **samples}
