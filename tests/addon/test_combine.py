# SPDX-License-Identifier: GPL-3.0-or-later
"""Mix and Add over materials: for constant light they must be the sums that their names say."""

import pytest

from addon.export.combine import add, mix
from addon.scene.description import (
    BLACK,
    WHITE,
    Add,
    Conductor,
    Glass,
    Lambert,
    Light,
    Material,
    Mirror,
    Mix,
    Null,
    Rgb,
    Translucent,
    Transparent,
)
from addon.scene.program import Op

GREY = Lambert((0.5, 0.5, 0.5))
RED = Lambert((0.8, 0.1, 0.1))
METAL = Conductor(alpha=0.1, f0=(0.9, 0.6, 0.3))
GLASS = Glass(1.5, alpha=0.2)
RADIANT = (3.0, 2.0, 1.0)


def leaving(material: Material) -> Rgb:
    """Radiance that leaves a surface under uniform light of radiance 1, with every lobe as its colour."""
    if isinstance(material, Light):
        return material.radiance
    if isinstance(material, Mix):
        a, b = leaving(material.a), leaving(material.b)
        own = tuple(material.weight * x + (1.0 - material.weight) * y for x, y in zip(a, b, strict=True))
    elif isinstance(material, Add):
        own = tuple(x + y for x, y in zip(leaving(material.a), leaving(material.b), strict=True))
    elif isinstance(material, Null | Glass):
        own = WHITE
    elif isinstance(material, Transparent):
        own = material.transmittance
    elif isinstance(material, Lambert | Translucent):
        own = material.albedo
    elif isinstance(material, Mirror):
        own = material.reflectance
    else:
        assert isinstance(material, Conductor) and material.f0 is not None
        own = material.f0
    emission = getattr(material, "emission", BLACK)
    return tuple(x + e for x, e in zip(own, emission, strict=True))


PAIRS = [
    (GREY, RED),
    (GREY, METAL),
    (Light((3.0, 2.0, 1.0)), GREY),
    (METAL, Light((3.0, 2.0, 1.0))),
    (Light((3.0, 2.0, 1.0)), Light((0.0, 5.0, 0.0))),
    (Lambert((0.2, 0.2, 0.2), emission=(1.0, 0.0, 0.0)), METAL),
    (Mirror((0.9, 0.9, 0.9)), Mirror((0.1, 0.2, 0.3))),
]


@pytest.mark.parametrize(("a", "b"), PAIRS)
@pytest.mark.parametrize("factor", [0.0, 0.25, 1.0])
def test_mix_is_the_weighted_sum(a: Material, b: Material, factor: float) -> None:
    expected = [(1.0 - factor) * x + factor * y for x, y in zip(leaving(a), leaving(b), strict=True)]
    assert leaving(mix(factor, a, b)) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("a", "b"), [pair for pair in PAIRS if isinstance(pair[0], Light) or isinstance(pair[1], Light)]
)
def test_add_of_emission_is_the_sum(a: Material, b: Material) -> None:
    expected = [x + y for x, y in zip(leaving(a), leaving(b), strict=True)]
    assert leaving(add(a, b)) == pytest.approx(expected)


@pytest.mark.parametrize(("a", "b"), [(GREY, RED), (GREY, METAL), (GLASS, GREY), (Transparent((0.2, 0.4, 0.6)), RED)])
def test_add_is_the_sum(a: Material, b: Material) -> None:
    expected = [x + y for x, y in zip(leaving(a), leaving(b), strict=True)]
    assert leaving(add(a, b)) == pytest.approx(expected)


@pytest.mark.parametrize(
    "other", [GREY, METAL, Translucent((0.1, 0.2, 0.3)), Transparent((0.2, 0.4, 0.6)), Light(RADIANT)]
)
@pytest.mark.parametrize("clear", [GLASS, Null()])
def test_glass_and_transparency_mix_with_anything(clear: Material, other: Material) -> None:
    expected = [0.7 * x + 0.3 * y for x, y in zip(leaving(clear), leaving(other), strict=True)]
    assert leaving(mix(0.3, clear, other)) == pytest.approx(expected)


def test_nothing_is_added_by_an_empty_socket() -> None:
    assert add(Null(), Light(BLACK)) == Null()
    assert add(Light(BLACK), GLASS) == GLASS


def test_parts_of_a_mix_hold_no_emission() -> None:
    result = mix(0.5, Lambert((0.2, 0.2, 0.2), emission=(1.0, 0.0, 0.0)), METAL)
    assert isinstance(result, Mix)
    assert result.a.emission == result.b.emission == BLACK


def test_transparent_alone_stays() -> None:
    assert mix(1.0, GREY, Null()) == Null()


@pytest.mark.parametrize("other", [METAL, Mix(0.5, GLASS, METAL)])
def test_what_does_not_shine_shines_by_no_program(other: Material) -> None:
    """All triangles of a material with a program for its emission are taken for lights."""
    varying = Op("attribute", (1.0,), ("center",), "number")
    for combined in (mix(varying, GREY, other), add(mix(varying, GREY, other), RED)):
        assert not isinstance(combined, (Light, Null))
        assert combined.emission == BLACK
