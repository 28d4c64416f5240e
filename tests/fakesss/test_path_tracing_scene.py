"""What Mitsuba is told of a scene: camera, lights and medium as numbers, without tracing a ray."""

import numpy as np
import pytest
from pydantic import ValidationError

from fakesss.camera import View
from fakesss.media import MEDIA
from fakesss.mesh import Mesh, mesh_from_triangles
from fakesss.offline.path_tracing import check
from fakesss.offline.physical_scene import RADIUS, physical_scene, sensor
from fakesss.offline.settings import PathTracing
from fakesss.problem import BadInput, validated
from fakesss.scene import Scene

MARBLE = MEDIA["marble"]


def told(**changes) -> dict:
    return physical_scene(Scene().replace(changes), MARBLE, 30.0)


def test_a_directional_light_gives_pi_times_its_intensity() -> None:
    light = told(**{"light.azimuth": 90, "light.elevation": 0, "light.diffuse": (0.5, 1.0, 2.0)})["light_0"]
    assert light["type"] == "directional"
    np.testing.assert_allclose(light["direction"], [-1, 0, 0], atol=1e-12)  # it shines from +x
    np.testing.assert_allclose(light["irradiance"]["value"], np.pi * np.array([0.5, 1.0, 2.0]))


def test_ambient_intensities_add_up_to_one_environment() -> None:
    more = [{"ambient": (0.1, 0.2, 0.3), "diffuse": (0.0, 0.0, 0.0)}]
    scene = physical_scene(Scene.from_dict({"lights": more}, "test"), MARBLE, 30.0)
    np.testing.assert_allclose(scene["ambient"]["radiance"]["value"], [0.19, 0.29, 0.395])
    assert set(scene) == {"integrator", "ambient", "light_0", "object"}


def test_a_point_light_has_the_irradiance_of_the_shader_at_any_distance() -> None:
    light = told(**{"light.kind": "point", "light.distance": 3.0, "light.attenuation": (0.0, 0.0, 0.25)})["light_0"]
    assert np.linalg.norm(light["position"]) == pytest.approx(3 * RADIUS)
    at_two_radii = np.array(light["intensity"]["value"]) / (2 * RADIUS) ** 2
    np.testing.assert_allclose(at_two_radii, np.pi / (0.25 * 4))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"light.kind": "point"}, r"light\.attenuation: \[1\.0, 0\.0, 0\.0\]: light falls with the square"),
        ({"light.kind": "spot"}, r"light\.kind: path-traced pictures have no spots"),
    ],
)
def test_a_light_that_is_none_in_physics_is_refused(changes: dict, sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        told(**changes)


def test_the_medium_is_scaled_instead_of_the_mesh() -> None:
    inside = told()["object"]["interior"]
    per_mm = np.array(inside["sigma_t"]["value"]) * inside["scale"] * RADIUS / 15
    np.testing.assert_allclose(per_mm, np.add(MARBLE.sigma_s_prime, MARBLE.sigma_a))
    np.testing.assert_allclose(inside["albedo"]["value"], np.divide(MARBLE.sigma_s_prime, per_mm))


def test_opaque_has_the_scenes_reflectance() -> None:
    made_of = physical_scene(Scene(), None, 30.0)["object"]
    assert made_of["bsdf"]["bsdf"]["reflectance"]["value"] == list(Scene().material.diffuse)


@pytest.mark.parametrize("size", [(40, 24), (24, 40)])
@pytest.mark.parametrize("angles", [(0.0, 8.0), (130.0, -40.0), (20.0, 90.0)])
def test_the_camera_is_the_shaders(size: tuple[int, int], angles: tuple[float, float]) -> None:
    mi = pytest.importorskip("mitsuba")
    mi.set_variant("scalar_rgb")
    scene = Scene().replace({"size": size, "camera.azimuth": angles[0], "camera.elevation": angles[1]})
    view, told = View.of(scene.camera, scene.size), sensor(scene, 0)
    told["to_world"] = mi.ScalarTransform4f(told["to_world"])
    camera, point = mi.load_dict(told), np.array([0.3, 0.2, -0.1])
    right, up, near = view.rotation @ point
    across = np.array([right, -up]) / (view.distance - near) / view.tangent / 2 + 0.5
    ray, _ = camera.sample_ray(0, 0, [float(part) for part in across], [0.5, 0.5])
    towards = point - view.distance * view.rotation[2]
    np.testing.assert_allclose(ray.d, towards / np.linalg.norm(towards), atol=1e-5)


def triangle() -> Mesh:
    return mesh_from_triangles(np.eye(3), np.array([[0, 1, 2]]), "test")


def test_an_open_surface_holds_no_medium() -> None:
    with pytest.raises(BadInput, match="its surface is open, and a medium needs a closed one"):
        check(Scene(object="sheet.obj"), triangle(), MARBLE)
    check(Scene(object="sheet.obj"), triangle(), None)


def test_a_camera_that_cuts_the_object_is_refused() -> None:
    with pytest.raises(BadInput, match="clip planes may cut the object open"):
        check(Scene().replace({"camera.near": 3.5}), triangle(), None)


@pytest.mark.parametrize("name", ["marble", "medium.marble", "Opaque"])
def test_a_medium_is_known_by_its_names(name: str) -> None:
    assert PathTracing(medium=name).medium == name.lower().removeprefix("medium.")


def test_settings_say_what_is_wrong() -> None:
    with pytest.raises(BadInput, match="study: medium: 'marbel': \"marbel\" is no measured medium; did you mean"):
        validated(PathTracing, {"medium": "marbel"}, "study")
    for samples in (10, 4, 1 << 21):
        with pytest.raises(ValidationError, match="must be a multiple of 4 from 8 to 1048576"):
            PathTracing(medium="marble", samples=samples)
    with pytest.raises(BadInput, match=r"study: size_mm: 1e-06: must be > 0\.1"):
        validated(PathTracing, {"medium": "marble", "size_mm": 1e-6}, "study")


def test_a_noise_target_ends_at_the_first_round_that_meets_it() -> None:
    settings = PathTracing(medium="marble", samples=64, noise=0.2)
    assert settings.rounds([]) == 16
    assert settings.rounds([0.9, 0.1, 0.5, 0.4, 0.3, 0.19, 0.25]) == 6  # not by chance at the second
    assert PathTracing(medium="marble", samples=64).rounds([0.0] * 5) == 16
    loud = PathTracing(medium="marble", samples=64, noise=0.5)
    assert loud.rounds([0.9, 0.9, 0.9, 0.49, 0.44]) == 5  # .49 of what is seen is .56 of what is there
