# SPDX-License-Identifier: GPL-3.0-or-later
"""What a body with subsurface scattering is filled with, and how light enters it; Disney's lobe in its parts. The walk
itself: tests/render/test_subsurface.py."""

from dataclasses import replace

import numpy as np
import pytest

from tests.engine.probe import bsdf, sampling
from tests.engine.probe.bsdf import Lobe
from tests.engine.significance import Family, relative_error
from tests.engine.test_bsdf import direction
from tests.engine.test_transmission import integrals
from tests.render.closed_forms import spherical_albedo

family = Family(size=8)
N = 100_000
MILK = Lobe(bsdf.SUBSURFACE, color=(0.9, 0.5, 0.2), f0=(0.3, 0.2, 0.1), eta=(1.4, 1, 1), alpha=1)


def test_a_half_space_has_the_colour() -> None:
    """The inversion against the exact spherical albedo of isotropic scattering."""
    for albedo in (0.99, 0.9, 0.7, 0.5, 0.3):
        found = bsdf.subsurface_medium(replace(MILK, color=(albedo,) * 3))
        assert spherical_albedo(float(found.alpha[0])) == pytest.approx(albedo, abs=0.005)
        assert (found.weight == 1).all()


def test_radii() -> None:
    """Mean free paths by each model; a dipole spreads dark light as far as bright light."""
    radius = np.array(MILK.f0)
    assert 1 / bsdf.subsurface_medium(MILK).sigma_t == pytest.approx(radius)
    fixed = replace(MILK, flag=bsdf.FIXED_RADIUS, curve_ior=0.5)
    assert 1 / bsdf.subsurface_medium(fixed).sigma_t == pytest.approx(radius / (4 * np.pi) * 0.5)
    skin = 1 / bsdf.subsurface_medium(replace(MILK, flag=bsdf.SKIN)).sigma_t / radius
    assert 0 < skin[0] < skin[1] < skin[2] < np.sqrt(3)
    assert 1 / bsdf.subsurface_medium(replace(MILK, flag=bsdf.SKIN, color=(0, 0, 0))).sigma_t == pytest.approx(
        radius * np.sqrt(3)
    )


def test_dark_media_are_cut_and_the_light_with_them() -> None:
    dark = bsdf.subsurface_medium(replace(MILK, color=(0.01, 0.001, 0.0)))
    assert dark.alpha == pytest.approx(0.2)
    assert dark.weight[2] == 0 < dark.weight[1] < dark.weight[0] < 1


@pytest.mark.parametrize("mu", [1.0, 0.5, 0.1])
@pytest.mark.parametrize("entry", [bsdf.REFRACTED, bsdf.DIFFUSE, bsdf.BOTH])
def test_entry(entry: int, mu: float) -> None:
    """All light enters, downwards; through smooth facets by Snell's law, diffusely by cosine."""
    smooth = replace(MILK, alpha=1e-6, masking=entry)
    s = bsdf.sample([smooth], direction(mu), sampling.uniform(1, N)[:, 0], sampling.uniform(2, N))
    assert (s.result == bsdf.SPECULAR + bsdf.TRANSMITTED).all()
    assert (s.wi[:, 2] < 0).all() and (s.weight == 1).all()
    below = float(np.sqrt(1 - (1 - mu**2) / 1.4**2))
    if entry == bsdf.REFRACTED:
        assert -s.wi[:, 2] == pytest.approx(below, abs=1e-3)
    else:
        share = 1 if entry == bsdf.DIFFUSE else 0.5
        family.mean(-s.wi[:, 2], share * 2 / 3 + (1 - share) * below, f"entry {entry} at {mu}", 1e-3)


def test_light_sampling_finds_nothing_at_the_entry() -> None:
    f, pdf = bsdf.evaluate([MILK], direction(0.7), [direction(0.5)])
    assert not f.any() and not pdf.any()


@pytest.mark.parametrize("roughness", [0.0, 0.4, 1.0])
def test_the_parts_of_disneys_lobe_are_the_whole(roughness: float) -> None:
    rng = np.random.default_rng(5)
    whole = Lobe(bsdf.BURLEY, color=(0.8, 0.5, 0.2), alpha=roughness)
    parts = [replace(whole, flag=part) for part in (bsdf.BASE, bsdf.RETRO)]
    for _ in range(50):
        wo, wi = (direction(rng.uniform(0.05, 1), rng.random()) for _ in range(2))
        both, one = (bsdf.evaluate(lobes, wo, [wi])[0] for lobes in (parts, [whole]))
        assert relative_error(both, one).max() <= 1e-5
    for lobe in parts:
        f = integrals([lobe], 1, direction(0.1), 12)[1]
        assert (f >= 0).all() and f.max() <= bsdf.max_value([lobe]) * (1 + 1e-5)
