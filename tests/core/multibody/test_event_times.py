"""The times of all events of worked scenes with contacts, against references at 40 digits."""

from __future__ import annotations

import pytest

from tests.core.multibody.event_references import REFERENCES, Reference, compared


@pytest.mark.parametrize("reference", REFERENCES, ids=lambda reference: reference.scene)
def test_events_are_right_to_their_conditioning_and_within_what_is_stated(reference: Reference) -> None:
    for one in compared(reference):
        assert one.off <= one.event.error <= one.allowed, one
