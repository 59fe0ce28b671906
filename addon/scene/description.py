# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole scene as frozen values: what the exporter makes, and what the engine and the scene file are given.

Units are the engine's: one length unit, degrees, linear RGB (Rec. 709 primaries), radiance in W/(m^2 sr), intensity in
W/sr, irradiance in W/m^2, sigma in inverse lengths. Matrices are (4, 4) float64, row-major, for column vectors.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import MISSING, dataclass, field, fields
from enum import IntFlag
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .program import Output, Program

Rgb = tuple[float, float, float]
Floats = NDArray[np.floating]
# Rgb and float, but where a parameter varies: an Op while the material is translated, then an Output of its program.
Color = Any
Number = Any


class Rays(IntFlag):
    """Kinds of rays, as the engine knows them."""

    CAMERA = 1
    DIFFUSE = 2
    GLOSSY = 4
    TRANSMISSION = 8
    VOLUME = 16
    SHADOW = 32


EVERY_RAY = Rays(63)
LAMP_RAYS = EVERY_RAY & ~Rays.CAMERA  # that meet a lamp of which nothing else is known

BLACK: Rgb = (0.0, 0.0, 0.0)
WHITE: Rgb = (1.0, 1.0, 1.0)


# ---- Film and camera ----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Mist:
    """Of the mist pass: 0 at `start` from the camera, 1 `depth` behind that."""

    start: float = 5.0
    depth: float = 25.0
    falloff: float = 2.0  # the exponent


@dataclass(frozen=True)
class Film:
    width: int
    height: int
    crop: tuple[int, int, int, int] | None = None  # x0, y0, x1, y1 from the top left; None is the whole picture
    filter: str = "box"  # or "blackman_harris"
    filter_width: float = 1.5  # full, in pixels
    exposure: float = 1.0  # factor of all light
    transparent: bool = False  # the environment is not seen: alpha is 0 there
    transparent_glass: float | None = None  # GGX width of the glass through which that holds; None: of none
    mist: Mist = Mist()
    occlusion_distance: float = 10.0  # of the ambient occlusion pass: what is farther does not count
    pixel_aspect: float = 1.0  # width / height of a pixel

    @property
    def window(self) -> tuple[int, int, int, int]:
        """What is rendered: x0, y0, x1, y1 from the top left."""
        return self.crop if self.crop is not None else (0, 0, self.width, self.height)


@dataclass(frozen=True)
class Perspective:
    fov_x: float  # full horizontal angle of the whole width, in degrees


@dataclass(frozen=True)
class Orthographic:
    width: float  # of what the whole picture shows, a length


# Panoramas: TYPE and the names of the fields are those of scene files.
WHOLE = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class Equirectangular:
    TYPE: ClassVar[str] = "equirectangular"
    longitude: tuple[float, float] = (-180.0, 180.0)  # degrees at the left and right edge, positive is right
    latitude: tuple[float, float] = (-90.0, 90.0)  # at the bottom and top edge
    window: tuple[float, float, float, float] = WHOLE  # the part that is shown: x0, y0, x1, y1, from the top left


@dataclass(frozen=True)
class Cylindrical:
    TYPE: ClassVar[str] = "cylindrical"
    longitude: tuple[float, float] = (-180.0, 180.0)
    elevation: tuple[float, float] = (-1.0, 1.0)  # tangent of the latitude at the bottom and top edge
    window: tuple[float, float, float, float] = WHOLE


@dataclass(frozen=True)
class FisheyeEquidistant:
    TYPE: ClassVar[str] = "fisheye_equidistant"
    fov: float = 180.0  # degrees from edge to edge
    window: tuple[float, float, float, float] = WHOLE


@dataclass(frozen=True)
class FisheyeEquisolid:
    TYPE: ClassVar[str] = "fisheye_equisolid"
    focal_length: float  # in widths of the whole panorama
    fov: float = 180.0  # degrees; nothing is seen outside this cone
    window: tuple[float, float, float, float] = WHOLE


@dataclass(frozen=True)
class FisheyePolynomial:
    TYPE: ClassVar[str] = "fisheye_polynomial"
    polynomial: tuple[float, ...]  # 5, of powers of the distance from the middle in widths; radians to the axis
    fov: float = 180.0
    window: tuple[float, float, float, float] = WHOLE


@dataclass(frozen=True)
class MirrorBall:
    TYPE: ClassVar[str] = "mirror_ball"
    window: tuple[float, float, float, float] = WHOLE


@dataclass(frozen=True)
class CubeFace:
    TYPE: ClassVar[str] = "cube_face"
    window: tuple[float, float, float, float] = WHOLE


Panorama = (
    Equirectangular | Cylindrical | FisheyeEquidistant | FisheyeEquisolid | FisheyePolynomial | MirrorBall | CubeFace
)
Projection = Perspective | Orthographic | Panorama


@dataclass(frozen=True)
class SphericalStereo:
    """One eye of a pair whose head turns to every direction, z up."""

    offset: float  # rays start so far to the right, below 0 to the left
    convergence: float = float("inf")  # the distance where the eyes' rays meet
    merge: tuple[float, float] = (180.0, 180.0)  # degrees from the horizon between which the offset falls to 0


@dataclass(frozen=True)
class Aperture:
    """The shape of a lens: round, or a regular polygon of three blades or more in the same circle."""

    blades: int = 0
    rotation: float = 0.0  # degrees, of the middle of an edge from right to up
    ratio: float = 1.0  # divides the extent from left to right


@dataclass(frozen=True)
class Camera:
    to_world: Floats  # rotation or reflection, and translation; looks along -z, y up
    projection: Projection
    shift: tuple[float, float] = (0.0, 0.0)  # in widths of the picture
    lens_radius: float = 0.0
    focus_distance: float = 1.0
    clip_start: float = 0.0  # along the axis; below 0, behind it, for an orthographic camera alone; of panoramas radii
    clip_end: float = float("inf")
    stereo: SphericalStereo | None = None
    aperture: Aperture = Aperture()
    motion: Floats | None = None  # (steps, 4, 4), evenly spaced while the shutter is open, in place of to_world


# ---- Materials ----------------------------------------------------------------------------------------------------
#
# TYPE and the names of the fields are those of the engine's table of materials, which scene files share; a field that
# has its default is not given (see `parameters`).


@dataclass(frozen=True)
class Lambert:
    """A diffuse surface; with a roughness above 0 Oren and Nayar's. facets: "multiple" adds the light that rough
    facets send on to each other, "tinted" the same times the albedo, as Cycles has it."""

    TYPE: ClassVar[str] = "lambert"
    albedo: Color
    emission: Color = BLACK
    roughness: float = 0.0
    facets: str = "single"


@dataclass(frozen=True)
class Mirror:
    TYPE: ClassVar[str] = "mirror"
    reflectance: Color
    emission: Color = BLACK


@dataclass(frozen=True)
class Conductor:
    """Rough reflection: GGX of width alpha, with the exact Fresnel equations of eta + i k, or a curve from f0 to f90 at
    grazing: Schlick's, times f82 at 82 degrees, or that of a dielectric of the index ior. facets: "multiple" adds the
    light that facets send on to each other. An aspect other than 1 is that of brushed metal."""

    TYPE: ClassVar[str] = "conductor"
    alpha: Number
    f0: Color = None
    eta: Color = None
    k: Color = None
    emission: Color = BLACK
    f90: Color = WHITE
    f82: Color = WHITE
    ior: Number = 0.0
    masking: str = "smith"
    facets: str = "single"
    aspect: Number = 1.0  # alpha across the tangent is alpha times this, along it alpha over this
    tangent: Color = BLACK
    rotation: Number = 0.0  # of the tangent about the normal, in turns


@dataclass(frozen=True)
class Glass:
    """The boundary of a dielectric: smooth, or rough with GGX of width alpha. lobes: "refraction" reflects nothing,
    whatever Fresnel's equations say."""

    TYPE: ClassVar[str] = "glass"
    ior: float
    alpha: Number = 0.0
    reflection: Color = WHITE
    transmission: Color = WHITE  # at each crossing
    lobes: str = "both"
    emission: Color = BLACK
    facets: str = "single"
    masking: str = "smith"


@dataclass(frozen=True)
class Transparent:
    TYPE: ClassVar[str] = "transparent"
    transmittance: Color  # of light that goes straight through
    emission: Color = BLACK


@dataclass(frozen=True)
class Translucent:
    """Lambert's lobe on the other side."""

    TYPE: ClassVar[str] = "translucent"
    albedo: Color
    emission: Color = BLACK


@dataclass(frozen=True)
class Burley:
    """Disney's diffuse surface. part: "whole", "base", which knows no roughness, or "retro", what rough surfaces send
    back."""

    TYPE: ClassVar[str] = "burley"
    albedo: Color
    roughness: Number
    emission: Color = BLACK
    part: str = "whole"


@dataclass(frozen=True)
class Sheen:
    """Cloth's shine towards grazing angles. model: "fibers", "schlick" or "velvet"."""

    TYPE: ClassVar[str] = "sheen"
    color: Color
    roughness: Number = 0.0
    model: str = "fibers"
    emission: Color = BLACK


@dataclass(frozen=True)
class Mix:
    TYPE: ClassVar[str] = "mix"
    weight: Number  # of a; the rest is b
    a: Surface
    b: Surface
    emission: Color = BLACK


@dataclass(frozen=True)
class Add:
    TYPE: ClassVar[str] = "add"
    a: Surface
    b: Surface
    emission: Color = BLACK


@dataclass(frozen=True)
class Layer:
    """a on top of b, which gets what a leaves to it."""

    TYPE: ClassVar[str] = "layer"
    weight: Number  # the part of b that a is above of
    a: Surface
    b: Surface
    emission: Color = BLACK


@dataclass(frozen=True)
class Subsurface:
    """Light that wanders within a body. model: what the radius means, "random_walk" (the mean free path),
    "fixed_radius" (4 pi of them) or "skin" (that of a diffusion dipole). entry: "refracted" by facets of ior and GGX
    width alpha, "diffuse", or "both", half by each. boundary: "lambert", or "burley", darker at grazing angles."""

    TYPE: ClassVar[str] = "subsurface"
    albedo: Color  # of a half-space
    radius: Color  # lengths
    model: str = "random_walk"
    entry: str = "refracted"
    ior: Number = 1.4
    alpha: Number = 1.0
    anisotropy: Number = 0.0  # mean cosine of scattering
    color: Color = WHITE  # factor of what comes out
    boundary: str = "lambert"
    emission: Color = BLACK


@dataclass(frozen=True)
class Light:
    TYPE: ClassVar[str] = "light"
    radiance: Color


@dataclass(frozen=True)
class Null:
    TYPE: ClassVar[str] = "null"


@dataclass(frozen=True)
class Holdout:
    """Black, and a hole where the camera sees it."""

    TYPE: ClassVar[str] = "holdout"
    emission: Color = BLACK


# What scatters light, and may also emit.
Surface = (
    Lambert
    | Mirror
    | Conductor
    | Glass
    | Transparent
    | Translucent
    | Burley
    | Sheen
    | Subsurface
    | Mix
    | Add
    | Layer
    | Holdout
)
Material = Surface | Light | Null


def parameters(material: Material) -> dict[str, Any]:
    """What a material gives of its type's parameters, by key."""
    given = {}
    for item in fields(material):
        value = getattr(material, item.name)
        if item.default is MISSING or value != item.default:
            given[item.name] = value
    return given


@dataclass(frozen=True)
class NamedMaterial:
    name: str
    material: Material
    pass_index: int = 0  # what Blender's material index pass shows
    program: Program | None = None  # what of the material varies
    normal: Output | None = None  # the shading normal, in the world
    normal_key: str = "normal"  # or "bumped_normal", "bumped_normal_cubic": how the terminator of bumps is softened
    volume: Medium | None = None  # what Blender fills the objects with that have the material
    aovs: tuple[tuple[int, Output], ...] = ()  # what the engine's AOV passes show of it, which count from 1
    casts_shadows: bool = True  # else shadow rays pass the objects that have it


# ---- Media --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Falloff:
    """A medium's coefficients times e^(-(z - height) / scale_height)."""

    height: float
    scale_height: float


@dataclass(frozen=True)
class Medium:
    sigma_a: Rgb | Output
    sigma_s: Rgb | Output
    g: float | Output = 0.0
    emission: Rgb | Output = BLACK  # radiance that a length adds; of a closed surface's medium alone
    program: Program | None = None  # what of it varies from place to place; of a closed surface's medium alone
    falloff: Falloff | None = None  # with height; of the medium that fills all space alone

    def constant_sigmas(self) -> tuple[Rgb, Rgb]:
        """sigma_a and sigma_s of a medium that is the same everywhere."""
        assert not isinstance(self.sigma_a, Output) and not isinstance(self.sigma_s, Output)
        return self.sigma_a, self.sigma_s

    def outputs(self) -> dict[str, Output]:
        """What the program gives, by its key."""
        values = {"sigma_a": self.sigma_a, "sigma_s": self.sigma_s, "g": self.g, "emission": self.emission}
        return {key: value for key, value in values.items() if isinstance(value, Output)}


# ---- Geometry -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Attribute:
    """What shader programs ask a mesh or its instances for."""

    name: str
    domain: str  # "vertex", "corner" (three rows a triangle), "face" (a row a triangle) or "instance"
    values: NDArray[np.float32]  # (n, 1 to 4)


@dataclass(frozen=True, eq=False)
class Mesh:
    name: str
    vertices: Floats  # (n, 3)
    triangles: NDArray[np.uint32]  # (t, 3)
    normals: Floats | None = None  # (n, 3) or None for flat; a zero normal means the face's own
    slots: NDArray[np.uint16] | None = None  # (t,): which of the object's materials; None: the first
    attributes: tuple[Attribute, ...] = ()

    @cached_property
    def digest(self) -> bytes:
        """Equal for meshes of equal content, so that frames and instances can share one."""
        state = hashlib.blake2b(digest_size=16)
        for array in (self.vertices, self.triangles, self.normals, self.slots):
            state.update(b"-" if array is None else str((array.dtype, array.shape)).encode())
            if array is not None:
                state.update(np.ascontiguousarray(array).view(np.uint8).data)
        for attribute in self.attributes:
            state.update(f"{attribute.name},{attribute.domain},{attribute.values.shape}".encode())
            state.update(np.ascontiguousarray(attribute.values, np.float32).reshape(-1).view(np.uint8).data)
        return state.digest()

    @cached_property
    def shape_digest(self) -> bytes:
        """Equal for meshes of the same triangles, whatever else they have."""
        state = hashlib.blake2b(digest_size=16)
        for array in (self.vertices, self.triangles):
            state.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
        return state.digest()

    @cached_property
    def is_closed(self) -> bool:
        """Whether it encloses a body, as the engine sees it (Mesh::is_closed)."""
        _, places = np.unique(self.vertices, axis=0, return_inverse=True)
        corners = places.reshape(-1)[self.triangles].astype(np.int64)
        begin, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
        edges = np.minimum(begin, end) * len(self.vertices) + np.maximum(begin, end)
        a, b, c = (np.asarray(self.vertices, np.float64)[self.triangles[:, k]] - self.vertices[0] for k in range(3))
        volume = float((a * np.cross(b, c)).sum())
        return volume > 0.0 and bool(np.array_equal(np.sort(edges[begin < end]), np.sort(edges[begin > end])))


@dataclass(frozen=True, eq=False)
class Object:
    name: str
    mesh: Mesh
    materials: tuple[int, ...]  # into SceneDescription.materials, one a slot
    to_world: Floats = field(default_factory=lambda: np.eye(4))
    instances: Floats | None = None  # (n, 4, 4), applied before to_world; None is a single one
    object_index: int = 0
    color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)  # with alpha: what shader programs know
    random: float | Floats = 0.0  # 0 to 1; (n,): one an instance
    motion: Floats | None = None  # (steps, 4, 4), evenly spaced while the shutter is open, in place of to_world
    rays: Rays = EVERY_RAY  # that meet it
    is_holdout: bool = False  # black where the camera sees it
    attributes: tuple[Attribute, ...] = ()  # of instances: a row each
    interior: Medium | None = None  # what the mesh is filled with, whatever its materials
    matte: int = 0  # 1 + its place in SceneDescription.mattes; 0: none
    light_group: int = 0  # of what shines of it, from 1 on; 0: none
    shadow_terminator: float = 0.0  # cosine below which lamps see a smooth mesh as curved


@dataclass(frozen=True, eq=False)
class Spheres:
    name: str
    centers: Floats  # (n, 3)
    radii: Floats  # (n,)
    material: int
    object_index: int = 0
    rays: Rays = EVERY_RAY
    is_holdout: bool = False
    interior: Medium | None = None
    matte: int = 0
    light_group: int = 0


# ---- Lights -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class LampProfile:
    """What a lamp's light is multiplied by, which varies over it and with the direction to what it lights."""

    program: Program  # its first output
    to_world: Floats  # (4, 4), of what the program knows as the object's space


@dataclass(frozen=True)
class LampFlags:
    """What all lamps have."""

    rays: Rays = LAMP_RAYS  # that meet it; with them the lobes that it lights
    shadows: bool = True
    max_bounces: int | None = None  # None: no limit
    light_group: int = 0
    profile: LampProfile | None = None


@dataclass(frozen=True)
class PointLight:
    name: str
    position: tuple[float, float, float]
    intensity: Rgb
    radius: float = 0.0
    is_disk: bool = False  # that faces what it lights; else a sphere
    flags: LampFlags = LampFlags()


@dataclass(frozen=True)
class SpotLight:
    name: str
    position: tuple[float, float, float]
    direction: tuple[float, float, float]
    intensity: Rgb
    angle: float
    blend: float
    radius: float = 0.0
    is_disk: bool = False
    times_cosine: bool = False  # darker by the cosine to its axis as well
    flags: LampFlags = LampFlags()


@dataclass(frozen=True)
class SunLight:
    name: str
    direction: tuple[float, float, float]
    irradiance: Rgb
    angle: float
    is_tangent: bool = False  # Cycles' law until 3.6, see the engine's tangent_sun_lamp.h
    flags: LampFlags = LampFlags()


@dataclass(frozen=True, eq=False)
class AreaLight:
    name: str
    to_world: Floats  # rigid; emits along its -z
    size: tuple[float, float]
    radiance: Rgb
    ellipse: bool = False
    spread: float = 180.0  # full angle about its normal, in degrees
    flags: LampFlags = LampFlags()


Lamp = PointLight | SpotLight | SunLight | AreaLight


@dataclass(frozen=True)
class SkySun:
    """The sun of a sky that a program gives, which shows it where it is asked for its `sun_disc`."""

    direction: tuple[float, float, float]  # of its light's travel
    angle: float  # full, degrees


@dataclass(frozen=True, eq=False)
class Environment:
    radiance: Rgb = BLACK  # one grey that multiplies the image where there is one
    image: NDArray[np.float32] | None = None  # (height, width, 3) linear, top row first, centre along +y, z up
    to_world: Floats = field(default_factory=lambda: np.eye(4))
    program: Program | None = None  # its first output is the radiance; but for the sun the rest is then not looked at
    rays: Rays = EVERY_RAY  # that see it
    sun: SkySun | None = None  # of the program
    light_group: int = 0


# ---- The whole ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class RenderSettings:
    integrator: str | None = None  # None: the engine's default
    samples: int = 0  # 0: no limit, as in the next two
    seconds: float = 0.0
    target_error: float = 0.0
    seed: int = 0
    threads: int = 0  # 0: all
    tile_size: int = 0  # 0: the engine's choice
    max_depth: int | None = None
    max_scatter: int | None = None
    adaptive: bool = False
    passes: tuple[str, ...] = ("combined",)  # the engine's names
    denoise: bool = False  # by the add-on, in the end
    independent_pixels: bool = False  # samples count for one pixel each, as denoisers need it


@dataclass(frozen=True)
class Matte:
    """What Cryptomatte knows an object by."""

    name: str
    asset: str  # the name of what it belongs to


@dataclass(frozen=True, eq=False)
class SceneDescription:
    film: Film
    camera: Camera
    materials: tuple[NamedMaterial, ...]
    objects: tuple[Object, ...] = ()
    spheres: tuple[Spheres, ...] = ()
    lights: tuple[Lamp, ...] = ()
    environment: Environment = field(default_factory=Environment)
    medium: Medium | None = None
    settings: RenderSettings = field(default_factory=RenderSettings)
    mattes: tuple[Matte, ...] = ()

    @property
    def has_alpha(self) -> bool:
        """Whether the picture may be empty in places."""
        holes = any(item.is_holdout for item in self.objects) or any(item.is_holdout for item in self.spheres)
        return self.film.transparent or holes

    def meshes(self) -> Iterator[Mesh]:
        """Each mesh of equal content once."""
        seen: set[bytes] = set()
        for item in self.objects:
            if item.mesh.digest not in seen:
                seen.add(item.mesh.digest)
                yield item.mesh
