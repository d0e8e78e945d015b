"""What can be undecided about a scene with contacts: one registry of codes.

docs/physics/undecided.md has a section for each, with the mechanics and its sources.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Code = Literal[
    "no-motion",
    "several-motions",
    "undetermined-friction",
    "simultaneous-impacts",
    "several-impacts",
    "no-impact",
    "energy-gain",
    "grazing-contact",
    "corner-on-corner",
    "several-onsets",
    "turning-onset",
    "no-progress",
    "event-limit",
    "lost-event",
    "formula",
    "cannot-begin",
]

DOCUMENT = "docs/physics/undecided.md"


@dataclass(frozen=True)
class UndecidedKind:
    """One kind of thing that ends a motion undecided.

    Attributes
    ----------
    code : str
        Stable name for machines.
    title, meaning : str
        The same for every occurrence.
    of_mechanics : bool
        Whether mechanics itself leaves it open; otherwise it is a limit of the solver.
    """

    code: Code
    title: str
    meaning: str
    of_mechanics: bool = True

    @property
    def section(self) -> str:
        """Its section in the documentation, from the root of the repository."""
        return f"{DOCUMENT}#{self.code}"


UNDECIDED: Mapping[Code, UndecidedKind] = {
    entry.code: entry
    for entry in (
        UndecidedKind(
            "no-motion",
            "No motion agrees with the equations (Painleve's paradox)",
            "Friction presses a sliding contact on more strongly than its inertia gives way: neither an open nor a "
            "closed contact satisfies rigid-body mechanics with Coulomb's friction.",
        ),
        UndecidedKind(
            "several-motions",
            "Several motions agree with the equations",
            "Different states of the contacts satisfy every condition, with different accelerations; candidates lists "
            "them.",
        ),
        UndecidedKind(
            "undetermined-friction",
            "Friction depends on an undetermined share of a load",
            "Several contacts share a load, rigid bodies leave the shares open, and the motion depends on them by "
            "friction.",
        ),
        UndecidedKind(
            "simultaneous-impacts",
            "Several impacts at one time, of which the order matters",
            "Contacts take impulses at one time, and the outcome depends on their order; candidates lists the "
            "outcomes, and order decides.",
        ),
        UndecidedKind(
            "several-impacts",
            "An impact has several outcomes",
            "Newton's restitution beside Coulomb's friction allows several outcomes of one impact; candidates lists "
            "them.",
        ),
        UndecidedKind(
            "no-impact",
            "An impact has no outcome",
            "No impulses satisfy Newton's restitution and Coulomb's friction at once.",
        ),
        UndecidedKind(
            "energy-gain",
            "An impact would add energy",
            "Newton's restitution beside Coulomb's friction would add energy to the motion.",
        ),
        UndecidedKind(
            "grazing-contact",
            "Whether a contact is reached is not known",
            "A gap turns back at zero, to the width of its error: a bounce and a miss differ by more than the error "
            "that could be stated.",
        ),
        UndecidedKind(
            "corner-on-corner",
            "Two corners meet",
            "Where two corners without radius meet, the direction in which they push one another is not determined.",
        ),
        UndecidedKind(
            "several-onsets",
            "Several contacts begin to slide at once in space",
            "Their directions follow from one another, and are not found.",
            of_mechanics=False,
        ),
        UndecidedKind(
            "turning-onset",
            "The direction of a beginning slip turns at once",
            "In space, the series of the motion has no start where a contact begins to slide while nothing presses it "
            "yet, in a direction that turns from the first moment on.",
            of_mechanics=False,
        ),
        UndecidedKind(
            "no-progress",
            "Events follow one another without time between them",
            "Events or impacts repeat at one time, to the last digit.",
            of_mechanics=False,
        ),
        UndecidedKind(
            "event-limit",
            "More events than one question may have",
            "The answer holds up to the last event that is listed; ask again from there.",
            of_mechanics=False,
        ),
        UndecidedKind(
            "lost-event",
            "An event cannot be located",
            "The error of the motion has grown as large as the motion, or bodies that attract come too close; the "
            "answer holds up to the last event, or to that time.",
            of_mechanics=False,
        ),
        UndecidedKind(
            "formula",
            "A formula does not say how the motion goes on",
            "A formula has no value beyond the state that is answered last, or either side of the zero on which its "
            "pieces depend leads back to it.",
        ),
        UndecidedKind(
            "cannot-begin",
            "A connection cannot begin where it should",
            "At its occasion the bodies are not where the connection could hold them: places that it joins are apart, "
            "or what it keeps apart overlaps.",
        ),
    )
}
