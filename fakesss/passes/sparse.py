"""The second layer of a solid at every n-th sample, and from there at all: an approximation (`layers.resolution`).

It costs a fraction of the samples and, where the layer is softened, of the softening, which is done before the layer
is brought to all samples. See `fakesss.sparse_layer`.
"""

from fakesss.calls import Setting, as_published, no_thickness
from fakesss.frame import Frame
from fakesss.frame_graph import DEPTH, Pass, TextureSpec
from fakesss.knob import Knob, Level, culled, first_of
from fakesss.passes.back_faces import faces_of, source
from fakesss.passes.geometry import draw_mesh
from fakesss.passes.layer import layer
from fakesss.sparse_layer import placing, sparse_size, texel_width

ALL = Level("all", {"layers.resolution": 1})
KNOBS = (
    Knob(
        name="second-layer resolution",
        levels=(Level("1/4", {"layers.resolution": 4}), Level("1/2", {"layers.resolution": 2}), ALL),
        reference=ALL,
        error="the second layer's edges, to n samples; what is thinner than n samples",
        unused=first_of(no_thickness, as_published, culled("sparse_back_faces", {"layers.resolution": 2})),
    ),
)


def why_not_sparse(setting: Setting) -> str:
    """Why the second layer has every sample, or "" where it has every n-th."""
    scene = setting.scene
    if scene.layers.resolution == 1:
        return "layers.resolution is 1"
    if scene.material.thickness != "first-interval":
        return f'layers.resolution is for the first interval, and material.thickness is "{scene.material.thickness}"'
    if scene.layers.method == "peel":
        return 'layers.resolution is for back faces, and layers.method is "peel"'
    if not setting.outside_only:
        return "layers.resolution is for solids seen from outside: of others, an empty sample says nothing of the next"
    return ""


def sparse_back_faces(setting: Setting) -> Pass:
    """Reads `mesh` or `coarse_mesh`; writes `sparse_back` (depth of the nearest back face at every n-th sample) and
    `sparse_coverage`, which keeps full-screen passes over it to where there is one."""
    every = setting.scene.layers.resolution
    size = sparse_size(setting.size, every)
    uniforms = {**setting.view.projection, **placing(setting.size, every)}

    def draw(frame: Frame) -> None:
        program = frame.program("sparse.vert", "back_faces.frag", uniforms, {})
        draw_mesh(frame, frame.inputs[source(setting)], setting.view, program, [], "front")

    return Pass(
        "sparse_back_faces",
        draw,
        **faces_of(setting),
        writes={"sparse_back": layer(setting, size), "sparse_coverage": TextureSpec(size, DEPTH)},
        depth_test=True,
    )


def upsampling(setting: Setting) -> tuple[dict[str, float], dict[str, int]]:
    """Uniforms and defines of `glsl/common_upsample.glsl`."""
    every = setting.scene.layers.resolution
    return {"texel_width": texel_width(setting.view, setting.size, every)}, {"EVERY": every}


def upsample(setting: Setting) -> Pass:
    """Reads `front` and `sparse_back`; writes `upsampled_back`: the nearest back face at every sample, about."""
    uniforms, defines = upsampling(setting)
    return Pass(
        "upsample",
        lambda frame: frame.fill("upsample.frag", uniforms, **defines),
        reads=("front", "sparse_back", "coverage"),
        writes={"upsampled_back": layer(setting)},
        mask="coverage",
    )
