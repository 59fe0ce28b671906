# SPDX-License-Identifier: GPL-3.0-or-later
"""One description, two ways into the engine: through ctypes as F12 goes, and through a scene file and the command line.
Both pictures must have the same bits, for every kind of thing that a description can hold.
"""

import subprocess
from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import pytest
from numpy.typing import NDArray

from addon.native import library
from addon.native.render import Tile, close_all, open_render
from addon.scene import description as d
from addon.scene.problems import GlimmerError
from addon.scene.program import Op, Table, Texture, compile_program, programmed
from addon.scene.writer import write_scene

SPP, SEED = 3, 11
MATERIALS = (
    d.NamedMaterial("floor", d.Lambert((0.6, 0.5, 0.4))),
    d.NamedMaterial("plate", d.Mix(0.3, d.Conductor(0.09, f0=(0.9, 0.7, 0.4)), d.Lambert((0.1, 0.2, 0.3)))),
    d.NamedMaterial("plate", d.Conductor(0.04, eta=(2.6, 2.4, 2.2), k=(3.3, 3.1, 2.9), emission=(0.2, 0.0, 0.1))),
    d.NamedMaterial("mirror", d.Mirror((0.9, 0.9, 0.8))),
    d.NamedMaterial("glass", d.Glass(1.5)),
    d.NamedMaterial("moon", d.Light((5.0, 3.0, 2.0))),
    d.NamedMaterial("gone", d.Null()),
)
FLOOR = d.Mesh(
    "floor",
    np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], np.float32),
    np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
)
TETRAHEDRON = d.Mesh(
    "tetrahedron",
    np.array([[0, 0, 1], [0.9, 0, -0.3], [-0.5, 0.8, -0.3], [-0.5, -0.8, -0.3]], np.float32),
    np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], np.uint32),
    normals=np.array([[0, 0, 1], [1, 0, 0], [-0.6, 0.8, 0], [0, 0, 0]], np.float32),
    slots=np.array([0, 1, 1, 0], np.uint16),
)


def place(x: float, y: float, z: float, turn: float = 0.0, size: float = 1.0) -> NDArray[np.float64]:
    return np.array(
        [
            [size * cos(turn), -size * sin(turn), 0, x],
            [size * sin(turn), size * cos(turn), 0, y],
            [0, 0, size, z],
            [0, 0, 0, 1],
        ]
    )


def camera() -> d.Camera:
    """Looks along +y and a little down."""
    tilt = pi / 2 - 0.35
    to_world = np.array(
        [[1, 0, 0, 0.2], [0, cos(tilt), -sin(tilt), -7], [0, sin(tilt), cos(tilt), 3.5], [0, 0, 0, 1]], np.float64
    )
    return d.Camera(
        to_world,
        d.Perspective(55.0),
        shift=(0.03, -0.02),
        lens_radius=0.05,
        focus_distance=7.0,
        aperture=d.Aperture(6, 10.0, 0.8),
        clip_end=60.0,
    )


SCENE = d.SceneDescription(
    film=d.Film(48, 32, crop=(5, 3, 44, 30), filter="blackman_harris", filter_width=1.5),
    camera=camera(),
    materials=MATERIALS,
    objects=(
        d.Object("floor", FLOOR, (0,), object_index=3),
        d.Object("one", TETRAHEDRON, (1, 2), place(-1.5, 0, 1, 0.4)),
        d.Object(
            "many", TETRAHEDRON, (2, 1), place(0.1, 0, 0), np.array([place(1, 1, 0.5), place(2.5, -1, 0.4, 1, 0.5)])
        ),
    ),
    spheres=(
        d.Spheres("mirror", np.array([[0.0, 2.0, 1.0]]), np.array([1.0]), 3),
        d.Spheres("moons", np.array([[-3.0, 3.0, 3.0], [3.0, 2.0, 2.5]]), np.array([0.4, 0.3]), 5, object_index=7),
        d.Spheres("glass", np.array([[0.3, -2.0, 0.6]]), np.array([0.5]), 4),
    ),
    lights=(
        d.PointLight("point", (2.0, -3.0, 4.0), (20.0, 15.0, 10.0)),
        d.PointLight("bulb", (-2.0, -3.0, 4.0), (5.0, 5.0, 10.0), radius=0.3),
        d.SpotLight("spot", (0.0, -4.0, 5.0), (0.1, 0.8, -1.0), (60.0, 60.0, 60.0), 50.0, 0.3, radius=0.1),
        d.SunLight("sun", (0.3, 0.2, -1.0), (0.5, 0.4, 0.3), 3.0),
        d.AreaLight("area", place(0, 0, 6, 0.3), (1.5, 0.7), (4.0, 4.0, 5.0), ellipse=True),
    ),
    environment=d.Environment((0.2, 0.3, 0.4)),
    settings=d.RenderSettings(samples=SPP, seed=SEED, max_depth=9),
)


def picture() -> NDArray[np.float32]:
    return np.random.default_rng(3).random((8, 16, 3), np.float32)


def hidden_from_some() -> d.SceneDescription:
    """All that may be hidden from rays, and all that lamps can be."""
    rays = d.EVERY_RAY
    flags = d.LampFlags(rays & ~d.Rays.DIFFUSE, False, 2)
    floor, one, many = SCENE.objects
    mirror, moons, glass = SCENE.spheres
    return replace(
        SCENE,
        film=replace(SCENE.film, exposure=1.5),
        objects=(floor, replace(one, rays=rays & ~d.Rays.CAMERA), replace(many, is_holdout=True)),
        spheres=(mirror, replace(moons, rays=rays & ~d.Rays.GLOSSY), replace(glass, is_holdout=True)),
        lights=(
            d.PointLight("disk", (-2.0, -3.0, 4.0), (5.0, 5.0, 10.0), 0.3, is_disk=True, flags=flags),
            d.SpotLight("spot", (0.0, -4.0, 5.0), (0.1, 0.8, -1.0), (60.0, 60.0, 60.0), 50.0, 0.3, 0.1, True, True),
            d.SunLight("sun", (0.3, 0.2, -1.0), (0.5, 0.4, 0.3), 30.0, is_tangent=True),
            d.AreaLight("area", place(0, 0, 6, 0.3), (1.5, 0.7), (4.0, 4.0, 5.0), spread=80.0),
        ),
        environment=replace(SCENE.environment, rays=rays & ~d.Rays.CAMERA),
    )


def varying() -> d.SceneDescription:
    """Programs that look at everything that programs can look at, and a sky with a sun."""
    random = np.random.default_rng(5)
    image = Texture("bricks", random.integers(0, 256, (5, 7, 4), np.uint8), srgb=True)
    ramp = Table(random.random((4, 4), np.float32), -1.0, 2.0)
    uv = Op("attribute", (1.0,), ("center",), "uv")
    color = Op("image", (uv, 0.0), ("flat", "linear", "repeat", "straight"), image)
    own = Op("attribute", (1.0,), ("center",), "own")
    tint = Op("ramp", (Op("separate", (own,), ("x",)),), ("linear",), ramp)
    albedo = Op("blend", (0.3, color, tint), ("mix", "clamped"))
    normal = Op("bump", (0.5, 0.1, 0.0, 0.02, 0.01, Op("geometry", (1.0,), ("normal", "center")), 1.0))
    (shape, turned), program = programmed((d.Lambert(albedo), normal))
    materials = (d.NamedMaterial("varies", shape, program=program, normal=turned), *MATERIALS[1:])
    mesh = replace(
        TETRAHEDRON, attributes=(d.Attribute("uv", "corner", random.random((12, 2), np.float32)),), slots=None
    )
    objects = tuple(
        replace(item, mesh=mesh, materials=(0,), color=(0.1, 0.2, 0.3, 0.4), random=0.25) for item in SCENE.objects[1:]
    )
    rows = random.random((2, 3), np.float32)
    objects = (objects[0], replace(objects[1], attributes=(d.Attribute("own", "instance", rows),)))
    direction = Op("geometry", (1.0,), ("position", "center"))
    shown = Op("math", (Op("geometry_number", (), ("sun_disc",)), 30.0, 0.0), ("multiply", "free"))
    sky = Op("vector_math", (direction, (1.0, 1.0, 1.0), Op("splat", (shown,)), 0.0), ("multiply_add",))
    sun = d.SkySun((0.3, 0.2, -1.0), 5.0)
    environment = d.Environment(program=compile_program([sky]), sun=sun)
    return replace(SCENE, materials=materials, objects=objects, environment=environment)


HAZE = d.Medium((0.1, 0.2, 0.0), (0.3, 0.5, 0.1), -0.2, emission=(0.0, 0.1, 0.3))


def varying_haze() -> d.Medium:
    """By the place in its body, and by voxels."""
    place = Op("geometry", (1.0,), ("object_position", "center"))
    voxels = Texture("voxels", np.random.default_rng(6).random((12, 2, 1), np.float32))
    density = Op("grid", (place, (2.0, 3.0, 4.0)), ("linear",), voxels)
    g = Op("separate", (place,), ("x",))
    found, program = programmed(d.Medium((0.1, 0.2, 0.0), density, g, emission=place))  # type: ignore[arg-type]
    assert isinstance(found, d.Medium)
    return replace(found, program=program)


WINDOW = (0.1, -0.05, 1.1, 0.9)
PANORAMAS: tuple[d.Panorama, ...] = (
    d.Equirectangular((-170.0, 150.0), (-80.0, 90.0), WINDOW),
    d.Cylindrical((-170.0, 150.0), (-0.5, 1.5), WINDOW),
    d.FisheyeEquidistant(200.0, WINDOW),
    d.FisheyeEquisolid(0.3, 200.0, WINDOW),
    d.FisheyePolynomial((0.001, 2.0, 0.3, -0.2, 0.1), 150.0, WINDOW),
    d.MirrorBall(WINDOW),
    d.CubeFace(WINDOW),
)
VARIANTS = {
    "hidden from some": hidden_from_some(),
    "plain": SCENE,
    "fog": replace(SCENE, medium=d.Medium((0.01, 0.02, 0.03), (0.05, 0.04, 0.03), 0.4)),
    "image": replace(SCENE, environment=d.Environment((0.7, 0.7, 0.7), picture(), place(0, 0, 0, 0.8))),
    "orthographic": replace(SCENE, camera=replace(camera(), projection=d.Orthographic(9.0), clip_start=-2.0)),
    **{
        f"panorama, {type(kind).__name__}": replace(
            SCENE,
            camera=replace(camera(), projection=kind, shift=(0.0, 0.0), clip_start=0.1, clip_end=50.0),
            medium=d.Medium((0.01, 0.02, 0.03), (0.05, 0.04, 0.03), 0.4),
        )
        for kind in PANORAMAS
    },
    "programs": varying(),
    "motion": replace(
        SCENE, objects=tuple(replace(o, motion=np.stack([o.to_world, place(1, 1, 0.2)])) for o in SCENE.objects[:1])
    ),
    "moving camera": replace(
        SCENE, camera=replace(camera(), motion=np.stack([camera().to_world, place(1, 1, 1) @ camera().to_world]))
    ),
    "interiors": replace(
        SCENE,
        objects=(*SCENE.objects[:2], replace(SCENE.objects[2], interior=HAZE)),
        spheres=(*SCENE.spheres[:-1], replace(SCENE.spheres[-1], interior=replace(HAZE, emission=d.BLACK))),
    ),
    "varying interiors": replace(
        SCENE, objects=(*SCENE.objects[:2], replace(SCENE.objects[2], interior=varying_haze()))
    ),
    "haze by height": replace(
        SCENE, medium=d.Medium((0.01, 0.02, 0.03), (0.05, 0.04, 0.03), 0.4, falloff=d.Falloff(1, 3))
    ),
    "empty": replace(SCENE, objects=(), spheres=(), lights=()),
}


def read_exr(path: Path) -> NDArray[np.float32]:
    image = OpenImageIO.ImageInput.open(str(path))
    assert image is not None, OpenImageIO.geterror()
    pixels = np.asarray(image.read_image(0, 0, 0, 3, OpenImageIO.FLOAT), np.float32)
    image.close()
    return pixels


@pytest.fixture
def engine(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv(library.VARIABLE, str(library_dir / "libglimmer.so"))
    library.load.cache_clear()
    yield library.load()
    close_all()
    library.load.cache_clear()


def through_ctypes(scene: d.SceneDescription) -> NDArray[np.float32]:
    x0, y0, x1, y1 = scene.film.window
    render, _ = open_render(scene)
    with render:
        render.start()
        render.wait(-1.0)
        return render.read("combined", Tile(0, 0, x1 - x0, y1 - y0))


@pytest.mark.parametrize("name", VARIANTS)
def test_the_command_line_renders_the_same_bits(engine: Any, glimmer_command: Path, tmp_path: Path, name: str) -> None:
    scene_file, out = tmp_path / "scene.json", tmp_path / "out.exr"
    write_scene(VARIANTS[name], scene_file)
    command = [str(glimmer_command), str(scene_file), "-o", str(out), "--spp", str(SPP), "--seed", str(SEED), "--quiet"]
    result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert result.returncode == 0, result.stderr
    direct = through_ctypes(VARIANTS[name])
    assert np.isfinite(direct).all() and direct.std() > 0.0
    np.testing.assert_array_equal(read_exr(out), direct)


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(GlimmerError, match=r"scene\.json cannot be written"):
        write_scene(SCENE, blocked / "scene.json")


def test_meshes_of_equal_content_are_one() -> None:
    copy = replace(TETRAHEDRON, vertices=TETRAHEDRON.vertices.copy())
    other = replace(TETRAHEDRON, slots=None)
    assert copy.digest == TETRAHEDRON.digest != other.digest
    objects = tuple(d.Object("o", mesh, (1, 2)) for mesh in (TETRAHEDRON, copy, other))
    assert len(list(replace(SCENE, objects=objects).meshes())) == 2
