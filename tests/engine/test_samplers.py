# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers, stratified points, warps and tables: each sampler against its density, each count against its law."""

import mpmath
import numpy as np
import pytest
from numpy.typing import ArrayLike
from scipy import stats

from tests.engine.probe import bsdf, sampling
from tests.engine.probe.call import Array
from tests.engine.significance import ROUNDING, Family, bin_integrals, histogram, relative_error

family = Family(size=43)
N = 200_000


def unit_grid(n: int = 16) -> Array:
    return np.full((n, n), 1 / n**2)


# ---- The counter-based generator ----


@pytest.mark.parametrize("key", ["x", "y", "replicate", "index", "skip"])
def test_numbers_are_uniform_and_independent_along_each_key(key: str) -> None:
    """Neighbours in any one key make independent pairs, and so do the two coordinates of next_2d."""
    sequence = np.arange(N)
    keys: dict[str, ArrayLike] = {"x": 3, "y": 5, "replicate": 1, "index": 7}
    if key == "skip":
        drawn = sampling.sampler(11, sequence, 5, 1, 7, skip=0), sampling.sampler(11, sequence, 5, 1, 7, skip=1)
        first, second, pairs = drawn[0].next_1d, drawn[1].next_1d, drawn[0].next_2d
    else:
        x, y, replicate, index = ({**keys, key: sequence}[name] for name in keys)
        numbers = sampling.sampler(11, x, y, replicate, index)
        first, second, pairs = numbers.next_1d[:-1:2], numbers.next_1d[1::2], numbers.next_2d
    family.chi_squared(histogram(first, second, 16, 16), unit_grid() * len(first), f"pairs along {key}")
    family.chi_squared(histogram(pairs[:, 0], pairs[:, 1], 16, 16), unit_grid() * len(pairs), f"next_2d along {key}")


def test_the_seed_gives_other_numbers() -> None:
    a, b = (sampling.sampler(seed, np.arange(N), 0, 0, 0) for seed in (0, 1))
    family.chi_squared(histogram(a.next_1d, b.next_1d, 16, 16), unit_grid() * N, "pairs along seed")
    family.chi_squared(
        histogram(a.stratified_1d, b.stratified_1d, 16, 16), unit_grid() * N, "stratified pairs along seed"
    )


@pytest.mark.parametrize("probability", [0.3, 1e-5, 3e-9, 1e-30])
def test_choices_are_as_rare_as_they_should_be(probability: float) -> None:
    """Also below the steps of the floats, 6e-8."""
    count = 1 << 27
    lower, upper = stats.binom.interval(1 - 1e-6, count, probability)
    assert lower <= sampling.next_bool(17, probability, count) <= upper


def test_numbers_stay_below_one() -> None:
    u = sampling.sampler(0, np.arange(1 << 22), 0, 0, 0)
    for values in (u.next_1d, u.next_2d, u.stratified_1d, u.stratified_2d):
        assert values.min() >= 0
        assert values.max() < 1
        assert (values * 2.0**24 == np.floor(values * 2.0**24)).all()


def test_mix_is_that_of_splitmix64() -> None:
    """The first numbers of SplitMix64 from seed 0, as its authors' program prints them."""
    golden = 0x9E3779B97F4A7C15
    published = [0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F]
    assert [sampling.mix64((i + 1) * golden % 2**64) for i in range(3)] == published


def test_hash_avalanches() -> None:
    """Flipping any input bit flips each output bit half of the time (z over the 64 flips counts, all inputs)."""
    rng = np.random.default_rng(5)
    flips = np.zeros(64)
    inputs = rng.integers(0, 1 << 63, 40)
    for a in map(int, inputs):
        base = sampling.hash64(a, 9)
        for bit in range(64):
            changed = base ^ sampling.hash64(a ^ (1 << bit), 9)
            flips += [(changed >> k) & 1 for k in range(64)]
    trials = len(inputs) * 64
    family.chi_squared(np.stack([flips, trials - flips]).T, np.full((64, 2), trials / 2), "avalanche")
    assert sampling.hash64(1, 2) != sampling.hash64(2, 1)


# ---- Exponential variates ----


def test_exponential_distribution() -> None:
    e = sampling.sampler(2, np.arange(N), 0, 0, 0).next_exponential.astype(np.float64)
    family.chi_squared(np.histogram(-np.expm1(-e), 100, (0, 1))[0], np.full(100, N / 100), "exponential")
    family.mean(e, 1, "mean of the exponential")


def exact_bits() -> tuple[list[int], Array]:
    """64-bit numbers over all magnitudes from both ends, and as the engine takes them."""
    bits = sorted({0, 1, 2**63 - 1, 2**63, 2**64 - 1, *(m * 2**k for k in range(62) for m in (1, 3)),
                   *(2**64 - 1 - m * 2**k for k in range(61) for m in (1, 3))})  # fmt: skip
    return bits, np.array(bits, np.uint64)


@pytest.mark.parametrize("tau", [None, 100.0, 20.0, 5.0, 1.5, 1.0, 0.5, 1e-3, 1e-5, 1e-6, 1e-7, 1e-8])
def test_exponential_inversion_is_exact_to_rounding(tau: float | None) -> None:
    """-log(1 - u (1 - e^-tau)) to six roundings at any u and tau, where plain float32 is 61 % off at 1e-7."""
    bits, engine_bits = exact_bits()
    mpmath.mp.dps = 50
    t = mpmath.inf if tau is None else mpmath.mpf(float(np.float32(tau)))
    exact = [-mpmath.log1p(-(mpmath.mpf(b) + 0.5) / 2**64 * (1 - mpmath.exp(-t))) for b in bits]
    got = sampling.exponential(engine_bits, tau)
    errors = [abs((float(g) - e) / e) for g, e in zip(got, exact, strict=True)]
    # Conditioning of the upper half: an error of v is multiplied by at most 1/(E (1/v - 1)) < 1.5 there.
    assert max(errors) <= 6 * ROUNDING
    assert (np.diff(got) >= -6 * ROUNDING * got[1:]).all()
    if tau is None:
        assert got[-1] > 44
        assert got[0] < 1e-19
    else:
        assert got.max() <= np.float32(tau)


# ---- Owen-scrambled Sobol ----


@pytest.mark.parametrize("log_n", [0, 1, 4, 7, 10])
@pytest.mark.parametrize("stratum", [0, 1, 1000])
def test_every_aligned_block_is_a_net(log_n: int, stratum: int) -> None:
    """(0, 2)-sequence: each elementary interval of area 2^-k holds one of the points m 2^k to (m + 1) 2^k - 1."""
    n = 1 << log_n
    for seed, block in ((0, 0), (1, 0), (2, 5), (3, 2**20 + 3)):
        index = np.arange(block * n, (block + 1) * n)
        points = sampling.sampler(seed, 17, 4, 2, index, stratum=stratum).stratified_2d.astype(np.float64)
        for split in range(log_n + 1):
            counts = histogram(points[:, 0], points[:, 1], 1 << split, 1 << (log_n - split))
            assert (counts == 1).all()


def test_one_dimension_and_bits_are_the_first_coordinate() -> None:
    p = sampling.sampler(3, 1, 2, 3, np.arange(64), stratum=9)
    assert (p.stratified_1d == p.stratified_2d[:, 0]).all()
    assert ((p.stratified_bits >> np.uint64(40)).astype(np.float64) * 2.0**-24 == p.stratified_1d).all()
    assert len(np.unique(p.stratified_bits & np.uint64(0xFFFFFFFF))) == 64


@pytest.mark.parametrize("index", [0, 1, 6])
def test_scrambled_points_are_uniform_over_scrambles(index: int) -> None:
    p = sampling.sampler(4, np.arange(N), 0, 0, index).stratified_2d
    family.chi_squared(histogram(p[:, 0], p[:, 1], 16, 16), unit_grid() * N, f"point {index} over pixels")


@pytest.mark.parametrize("axis", [0, 1])
def test_replicates_sets_and_pixels_are_independent(axis: int) -> None:
    """The same index under two keys makes independent pairs."""
    x = np.arange(N)
    base = sampling.sampler(5, x, 0, 0, 3, stratum=2).stratified_2d[:, axis]
    others = {
        "replicates": sampling.sampler(5, x, 0, 1, 3, stratum=2),
        "sets": sampling.sampler(5, x, 0, 0, 3, stratum=3),
        "rows": sampling.sampler(5, x, 1, 0, 3, stratum=2),
    }
    for name, other in others.items():
        pairs = histogram(base, other.stratified_2d[:, axis], 16, 16)
        family.chi_squared(pairs, unit_grid() * N, f"{name}, axis {axis}")


def test_sets_are_shuffled_against_each_other() -> None:
    """Two sets with equal shuffles would pair their points along a structure; over many indices, none shows."""
    index = np.arange(1 << 16)
    a = sampling.sampler(6, 0, 0, 0, index, stratum=0).stratified_2d[:, 0]
    b = sampling.sampler(6, 0, 0, 0, index, stratum=1).stratified_2d[:, 0]
    counts = histogram(a, b, 16, 16)
    # Not independent draws (each margin is exactly even), so chi-squared has 15^2 degrees of freedom.
    expected = len(index) / 256
    statistic = ((counts - expected) ** 2 / expected).sum()
    family.check(float(stats.chi2.sf(statistic, 225)), f"padding: chi-squared {statistic:.1f}")


# ---- Warps ----


def turn(x: Array, y: Array) -> Array:
    """The angle of (x, y) as a fraction of the full turn."""
    return (np.arctan2(np.float64(y), np.float64(x)) / (2 * np.pi)) % 1


def test_uniform_sphere() -> None:
    w, pdf = sampling.warp(sampling.UNIFORM_SPHERE, sampling.uniform(21, N))
    assert relative_error((w.astype(np.float64) ** 2).sum(1), np.ones(N)).max() <= 12 * ROUNDING
    family.chi_squared(histogram((w[:, 2] + 1) / 2, turn(w[:, 0], w[:, 1]), 16, 16), unit_grid() * N, "sphere")
    assert relative_error(pdf, np.full(N, 1 / (4 * np.pi))).max() <= 2 * ROUNDING


def test_cosine_hemisphere() -> None:
    w, pdf = sampling.warp(sampling.COSINE_HEMISPHERE, sampling.uniform(22, N))
    assert (w[:, 2] >= 0).all()
    cell = bin_integrals(
        lambda z, phi: 2 * np.pi * bsdf.evaluate([bsdf.Lobe(bsdf.LAMBERT)], (0, 0, 1), direction(z, phi))[1], 16, 16
    )
    family.chi_squared(histogram(w[:, 2], turn(w[:, 0], w[:, 1]), 16, 16), cell * N, "cosine hemisphere")
    assert relative_error(pdf, np.maximum(w[:, 2], 1e-30).astype(np.float64) / np.pi)[w[:, 2] > 0].max() <= 3 * ROUNDING


def direction(z: Array, phi: Array) -> Array:
    r = np.sqrt(np.maximum(0, 1 - z * z))
    return np.stack([r * np.cos(2 * np.pi * phi), r * np.sin(2 * np.pi * phi), z], axis=1)


def test_disk() -> None:
    w, pdf = sampling.warp(sampling.DISK, sampling.uniform(23, N))
    radius2 = (w.astype(np.float64) ** 2).sum(1)
    assert radius2.max() <= 1 + 12 * ROUNDING
    family.chi_squared(histogram(radius2, turn(w[:, 0], w[:, 1]), 16, 16), unit_grid() * N, "disk")
    assert relative_error(pdf, np.full(N, 1 / np.pi)).max() <= 2 * ROUNDING


def test_triangle() -> None:
    b, pdf = sampling.warp(sampling.TRIANGLE_BARYCENTRICS, sampling.uniform(24, N))
    assert (b >= 0).all()
    assert np.abs(b.astype(np.float64).sum(1) - 1).max() <= 2 * ROUNDING
    # (1 - b0)^2 and b1/(b1 + b2) are uniform over a triangle.
    rest = 1 - np.float64(b[:, 0])
    family.chi_squared(histogram(rest**2, b[:, 1] / np.maximum(rest, 1e-30), 16, 16), unit_grid() * N, "triangle")
    assert (pdf == 2).all()


@pytest.mark.parametrize("one_minus_cos_max", [2.0, 1.0, 0.3, 1e-6, 1e-12])
def test_cone(one_minus_cos_max: float) -> None:
    """Also a cone of a microradian: there the sine tells the angle, 1 - z has no digits."""
    w, pdf = sampling.warp(sampling.CONE, sampling.uniform(25, N), one_minus_cos_max)
    sine2 = np.float64(w[:, 0]) ** 2 + np.float64(w[:, 1]) ** 2
    z = np.float64(w[:, 2])
    omc = np.where(z > 0.5, sine2 / (1 + np.sqrt(np.maximum(0, 1 - sine2))), 1 - z)
    counts = histogram(omc / one_minus_cos_max, turn(w[:, 0], w[:, 1]), 16, 16)
    family.chi_squared(counts, unit_grid() * N, f"cone {one_minus_cos_max}")
    assert (
        relative_error(pdf, np.full(N, 1 / (2 * np.pi * np.float64(np.float32(one_minus_cos_max))))).max()
        <= 4 * ROUNDING
    )


@pytest.mark.parametrize("s", [1.0, 0.999, 0.5, 1e-3, 1e-4, 1e-5, 1e-6, 1e-15])
def test_one_minus_cos_of_a_distant_sphere(s: float) -> None:
    """DESIGN's hazard: 1 - sqrt(1 - s^2) is 7 % off at 1e-3 and 0 at 1e-4."""
    mpmath.mp.dps = 60
    m = mpmath.mpf(float(np.float32(s)))
    exact = 1 - mpmath.sqrt(1 - m * m)
    assert abs((sampling.one_minus_cos(s) - exact) / exact) <= 6 * ROUNDING


# ---- Tables ----


def test_alias_table_draws_its_weights() -> None:
    weights = [0, 1, 2.5, 0, 1e-3, 30, 0.5, 0, 7]
    drawn = sampling.alias_table(weights, sampling.uniform(31, N))
    assert drawn is not None
    index, pmf, every, rest = drawn
    exact = np.array(weights) / np.sum(weights)
    assert relative_error(every[exact > 0], exact[exact > 0]).max() <= ROUNDING
    assert (every[exact == 0] == 0).all()
    assert (pmf == every[index]).all()
    family.chi_squared(np.bincount(index, minlength=len(weights)), every.astype(np.float64) * N, "alias table")
    for i in np.flatnonzero(exact > 0.01):  # what is left of the number is uniform again, whatever was drawn
        cells = np.histogram(rest[index == i], 50, (0, 1))[0]
        family.chi_squared(cells, np.full(50, cells.sum() / 50), f"rest of the number at entry {i}")
    assert rest.min() >= 0
    assert rest.max() < 1


def test_alias_table_of_a_million() -> None:
    """Cells of a 24-bit number alone would be 6 % unequal."""
    rng = np.random.default_rng(32)
    weights = rng.exponential(size=1_000_000) ** 2 * (rng.random(1_000_000) > 0.1)
    draws = 10_000_000
    drawn = sampling.alias_table(weights, sampling.uniform(33, draws))
    assert drawn is not None
    family.chi_squared(np.bincount(drawn[0], minlength=len(weights)), drawn[2].astype(np.float64) * draws, "a million")


def test_alias_table_extremes() -> None:
    u = sampling.uniform(34, 1000)
    assert sampling.alias_table([0, 0, 0], u) is None
    assert sampling.alias_table([], u) is None
    for weights, only in (([5.0], 0), ([0, 0, 1e-300], 2), ([0, 1e300, 0, 0], 1)):
        drawn = sampling.alias_table(weights, u)
        assert drawn is not None
        assert (drawn[0] == only).all()
        assert (drawn[1] == 1).all()


def test_distribution_2d_draws_its_density() -> None:
    rng = np.random.default_rng(35)
    weights = rng.exponential(size=(12, 20)).astype(np.float32)
    weights[3], weights[:, 7], weights[5, 5] = 0, 0, 400
    u = sampling.uniform(36, N)
    drawn = sampling.distribution_2d(weights, u)
    assert drawn is not None
    uv, pdf, twin, texels = drawn
    assert (pdf == twin).all()
    # A step of 2^-24 more or less in the row and in its column.
    rows = weights.sum(1, dtype=np.float64) / weights.sum(dtype=np.float64)
    columns = weights / np.maximum(weights.sum(1, dtype=np.float64), 1e-30)[:, None]
    exact = rows[:, None] * columns
    assert (np.abs(texels / weights.size - exact) <= (rows[:, None] + columns) * 2.0**-24 + 4 * ROUNDING * exact).all()
    cells = texels.astype(np.float64).ravel() * N / weights.size
    counts = histogram(uv[:, 1], uv[:, 0], 12, 20).ravel()
    assert (texels[weights == 0] == 0).all()
    family.chi_squared(counts, cells, "distribution over an image")
    # Within a texel, too: quarters of the bright one.
    x, y = uv[:, 0] * 20 - 5, uv[:, 1] * 12 - 5
    bright = (x >= 0) & (x < 1) & (y >= 0) & (y < 1)
    quarters = histogram(x[bright], y[bright], 4, 4)
    family.chi_squared(quarters, unit_grid(4) * bright.sum(), "within a texel")


def test_distribution_2d_is_exact_to_the_count() -> None:
    """Of all 2^24 numbers, the share that pdf claims falls into each column; a dim texel beside a sun keeps one."""
    weights = np.array([[1e9, 1e-9, 0, 3e8, 1]], np.float32)
    u = np.stack([np.arange(1 << 24) * 2.0**-24, np.zeros(1 << 24)], axis=1).astype(np.float32)
    drawn = sampling.distribution_2d(weights, u)
    assert drawn is not None
    counts = np.bincount((drawn[0][:, 0] * 5).astype(int), minlength=5)
    exact = drawn[3][0].astype(np.float64) / 5 * 2.0**24
    assert np.abs(counts - exact).max() <= 3 * ROUNDING * counts.max()
    assert counts[1:3].tolist() == [1, 0]
    assert exact[1:3].tolist() == pytest.approx([1, 0], rel=3 * ROUNDING)
    assert drawn[0].max() < 1


def test_distribution_2d_of_black() -> None:
    assert sampling.distribution_2d(np.zeros((4, 4)), sampling.uniform(1, 10)) is None
