# SPDX-License-Identifier: GPL-3.0-or-later
"""All cases."""

from functools import cache

from tests.check import direct, fog, furnaces, geometry, invariants
from tests.check.case import Case


@cache
def every_case() -> tuple[Case, ...]:
    """Names are unique."""
    result = tuple(case for module in (direct, furnaces, fog, geometry, invariants) for case in module.cases())
    names = [case.name for case in result]
    assert len(set(names)) == len(names), sorted(name for name in set(names) if names.count(name) > 1)
    return result


def chosen(quick: bool, words: str | None = None) -> list[Case]:
    """The cases of a tier whose name holds `words`."""
    return [case for case in every_case() if (case.quick or not quick) and (not words or words in case.name)]
