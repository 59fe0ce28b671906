# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte: names as floats, ranks and metadata, against what Cycles writes."""

import json
from types import SimpleNamespace

import numpy as np

from addon.film.cryptomatte import as_float, layer, metadata, murmur3, ranks
from addon.film.passes import enabled


def test_names_are_hashed_as_cycles_does() -> None:
    for name, expected in (("Cube", "a8fce865"), ("default_surface", "78d05529"), ("Material", "3913209d")):
        assert f"{murmur3(name.encode()):08x}" == expected


def test_no_hash_becomes_a_number_that_cannot_be_compared() -> None:
    for hashed in (0, 0x7FFFFFFF, 0xFF800000, 0x80000001, 0x00000001):
        value = as_float(hashed)
        assert np.isfinite(value) and abs(value) >= np.finfo(np.float32).tiny
    assert as_float(0x3F800000) == 1.0


def test_numbers_of_one_name_are_one() -> None:
    pairs = np.array([[[1, 0.2, 2, 0.3, 3, 0.4, 0, 0]]], np.float32)
    a, b = (as_float(murmur3(name.encode())) for name in ("a", "b"))
    np.testing.assert_allclose(layer(ranks(pairs, ["a", "b", "a"]), 0), [[[a, 0.6, b, 0.3]]], rtol=1e-6)
    np.testing.assert_array_equal(layer(ranks(pairs, ["a", "b", "a"]), 1), [[[0, 0, 0, 0]]])


def test_metadata_is_as_cycles_has_it() -> None:
    found = dict(metadata("ViewLayer", "object", ["Cube"]))
    assert found["cryptomatte/542cafa/name"] == "ViewLayer.CryptoObject"
    assert found["cryptomatte/542cafa/hash"] == "MurmurHash3_32"
    assert found["cryptomatte/542cafa/conversion"] == "uint32_to_float32"
    assert json.loads(found["cryptomatte/542cafa/manifest"]) == {"Cube": "a8fce865"}


def test_a_layer_has_two_levels_a_pass() -> None:
    view_layer = SimpleNamespace(use_pass_cryptomatte_asset=True, pass_cryptomatte_depth=5)
    assert [item.short_name for item in enabled(view_layer)[1:]] == ["CryptoAsset00", "CryptoAsset01", "CryptoAsset02"]
