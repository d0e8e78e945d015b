"""A notice seen from an enclosing object has the same code and detail, and a longer path."""

from __future__ import annotations

from dataclasses import FrozenInstanceError

import pytest

from core.notices import Notice


def test_a_path_grows_outwards() -> None:
    notice = Notice("unphysical-inertia", "said once", ("moments",))
    outside = notice.inside("body").inside("parts", 3)
    assert outside == Notice("unphysical-inertia", "said once", ("parts", 3, "body", "moments"))
    assert notice.path == ("moments",)
    assert Notice("x", "y").inside("a").path == ("a",)


def test_a_notice_cannot_be_changed() -> None:
    with pytest.raises(FrozenInstanceError):
        Notice("x", "y").code = "z"  # type: ignore[misc]
