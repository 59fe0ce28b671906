# SPDX-License-Identifier: GPL-3.0-or-later
"""Mix and Add over materials: for constant light they must be the sums that their names say."""

import pytest

from addon.export.combine import add, mix
from addon.scene.description import BLACK, Conductor, Glass, Lambert, Light, Material, Mirror, Mix, Null, Rgb

GREY = Lambert((0.5, 0.5, 0.5))
RED = Lambert((0.8, 0.1, 0.1))
METAL = Conductor(alpha=0.1, f0=(0.9, 0.6, 0.3))


def leaving(material: Material) -> Rgb:
    """Radiance that leaves a surface under uniform light of radiance 1, with every lobe as its colour."""
    if isinstance(material, Light):
        return material.radiance
    if isinstance(material, Mix):
        a, b = leaving(material.a), leaving(material.b)
        own = tuple(material.weight * x + (1.0 - material.weight) * y for x, y in zip(a, b, strict=True))
    elif isinstance(material, Lambert):
        own = material.albedo
    elif isinstance(material, Mirror):
        own = material.reflectance
    else:
        assert isinstance(material, Conductor) and material.f0 is not None
        own = material.f0
    return tuple(x + e for x, e in zip(own, material.emission, strict=True))  # type: ignore[return-value]


def silent(what: str) -> None:
    raise AssertionError(f"nothing is approximated here, yet: {what}")


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
    assert leaving(mix(factor, a, b, silent)) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("a", "b"), [pair for pair in PAIRS if isinstance(pair[0], Light) or isinstance(pair[1], Light)]
)
def test_add_of_emission_is_the_sum(a: Material, b: Material) -> None:
    expected = [x + y for x, y in zip(leaving(a), leaving(b), strict=True)]
    assert leaving(add(a, b, silent)) == pytest.approx(expected)


def test_add_of_diffuse_is_the_sum() -> None:
    assert add(GREY, Lambert((0.1, 0.2, 0.3)), silent) == Lambert((0.6, 0.7, 0.8))


def test_add_beyond_all_light_is_cut_and_told() -> None:
    told: list[str] = []
    assert add(GREY, RED, told.append) == Lambert((1.0, 0.6, 0.6))
    assert len(told) == 1


@pytest.mark.parametrize(("factor", "expected"), [(0.3, Glass(1.5)), (0.7, GREY)])
def test_a_mix_with_glass_takes_the_larger_part_and_tells(factor: float, expected: Material) -> None:
    told: list[str] = []
    assert mix(factor, Glass(1.5), GREY, told.append) == expected
    assert len(told) == 1


def test_parts_of_a_mix_hold_no_emission() -> None:
    result = mix(0.5, Lambert((0.2, 0.2, 0.2), emission=(1.0, 0.0, 0.0)), METAL, silent)
    assert isinstance(result, Mix)
    assert result.a.emission == result.b.emission == BLACK


def test_transparent_alone_stays() -> None:
    assert mix(1.0, GREY, Null(), silent) == Null()
