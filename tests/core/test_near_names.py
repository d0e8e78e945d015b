"""The name that was meant, and the list of those that exist."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from core.near_names import ALIKE_IN_SCENE, LONGEST_NAME, MOST_LISTED, did_you_mean, near_and_all, nearest

NAMES = ("bob", "wheel", "left-wall")


def test_a_name_is_found_by_its_letters_by_a_synonym_and_when_it_is_misspelt() -> None:
    assert nearest("Left_Wall", NAMES) == "left-wall"
    assert nearest("drum", NAMES) is None
    assert nearest("drum", NAMES, synonyms={"wheel": ("drum",)}) == "wheel"
    # Two letters of three are alike: enough in a scene, where all names are listed beside the guess.
    assert nearest("bop", NAMES) is None
    assert nearest("bop", NAMES, ALIKE_IN_SCENE) == "bob"


def test_the_remedy_has_the_guess_and_the_list() -> None:
    assert near_and_all("bop", NAMES, "bodies") == 'did you mean "bob"? the bodies here are bob, wheel, left-wall'
    assert near_and_all("rope", NAMES, "bodies") == "the bodies here are bob, wheel, left-wall"
    assert near_and_all({"at": [0, 0]}, NAMES, "bodies") == "the bodies here are bob, wheel, left-wall"
    assert did_you_mean(None, NAMES) is None


def test_a_long_list_is_cut_and_its_rest_counted() -> None:
    names = [f"p{i}" for i in range(MOST_LISTED + 3)]
    assert near_and_all("", names, "bodies").endswith(f"p{MOST_LISTED - 1} and 3 more")


@given(st.text(max_size=3 * LONGEST_NAME))
def test_whatever_is_written_is_answered_with_a_name_or_none(written: str) -> None:
    found = nearest(written, NAMES, ALIKE_IN_SCENE)
    assert found is None or found in NAMES
    if len(written) > LONGEST_NAME:
        assert found is None
