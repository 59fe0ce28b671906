# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong, in words for the user."""


class FarmError(Exception):
    """One line: what, where, and what is allowed."""


def one_line(text: str) -> str:
    """What another machine says, made fit to be shown: no control characters, and not endless."""
    return "".join(c if c.isprintable() else " " for c in text).strip()[:400]
