"""What connections bring besides rows: forces, works, limits, and measures that stay at or above zero."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from core.errors import Path
from core.multibody.algebra.polynomials import ZERO, Ball, LinearForm, Poly, gradient
from core.multibody.language.contacts import ImpactLaw


@dataclass(frozen=True)
class Force:
    """A force of a connection: sum of multipliers times polynomials, plus what the coordinates and rates alone say.

    Attributes
    ----------
    name : str
        For example ``"hinge.x"``.
    unit : str
        "N" or "N m".
    terms : list of (row, polynomial)
    of_state : polynomial
    of_rates : dict
        Constant coefficients of rates.
    of_squares : dict
        Constant coefficients of squares of rates.
    of_laws : dict
        Constant coefficients of the values of laws, by their number in the table.
    """

    name: str
    unit: str
    terms: list[tuple[int, Poly]] = field(default_factory=list)
    of_state: Poly = field(default_factory=dict)
    of_rates: dict[int, Ball] = field(default_factory=dict)
    of_squares: dict[int, Ball] = field(default_factory=dict)
    of_laws: dict[int, Ball] = field(default_factory=dict)


@dataclass(frozen=True)
class WorkTerm:
    """What takes or brings energy: a potential, or a power.

    Attributes
    ----------
    name : str
    potential : polynomial or None
        Whose fall is the work.
    square : (ball, dict) or None
        Of a damper: coefficient and the linear form in the rates whose square it takes.
    terms : list of (ball, coordinate, rate)
        Power as factor times coordinate times rate.
    rows : list of (row, polynomial)
        Power of what is driven: the multiplier of the row times less what the row says of the clock.
    laws : list of int
        Numbers of the laws of the table whose forces have the power.
    """

    name: str
    potential: Poly | None = None
    square: tuple[Ball, dict[int, Ball]] | None = None
    terms: list[tuple[Ball, int, int]] = field(default_factory=list)
    rows: list[tuple[int, Poly]] = field(default_factory=list)
    laws: list[int] = field(default_factory=list)


@dataclass(frozen=True)
class Limit:
    """Something that has to stay positive, and whose loss ends a scene.

    Attributes
    ----------
    event : str
        "slack" for the tension of a string, "lift-off" for the force on the peg of a chain, "end-of-chain" for the
        length of one side of it, "singular" for another length.
    name : str
        The connection.
    force : int or None
        Number of the force that has to stay positive.
    length : polynomial or None
        The length that has to.
    scale : float
        Size of the forces beside which it may be nothing but noise.
    """

    event: str
    name: str
    force: int | None = None
    length: Poly | None = None
    scale: float = 0.0


@dataclass(frozen=True)
class Kept:
    """A polynomial of the coordinates that keeps its value all the time, where a law rests on that.

    Attributes
    ----------
    measure : polynomial
    rule, remedy : str
        What the description must be, and how, where it does not.
    path : path
        To what of the description the rule concerns.
    """

    measure: Poly
    rule: str
    remedy: str
    path: Path


@dataclass(frozen=True)
class LevelRim:
    """What has to hold of rims that four places stand for.

    Attributes
    ----------
    name : str
        Of the contact.
    leaning : tuple of polynomial
        Components of the normal along the two diameters: one of them stays zero.
    heading : tuple of int
        Coordinates of the first body axis.
    path : path
    """

    name: str
    leaning: tuple[Poly, Poly]
    heading: tuple[int, ...]
    path: Path


@dataclass(frozen=True)
class Facet:
    """A part of an outline that a corner may meet: an edge between its ends, or the arc about a corner.

    Attributes
    ----------
    gap : polynomial
    slip : linear form in the rates, or None
    region : tuple of polynomial
        At or above zero where this is the part that is nearest.
    sides : tuple of (polynomial, polynomial)
        Of each edge that ends at the corner itself, its components along the outward normal and along an edge on which
        the corner lies: the first are at or above zero where its outline is on the free side.
    edge : bool
        Whether a gap above zero is enough to say that nothing touches, wherever it is.
    """

    gap: Poly
    slip: LinearForm | None
    region: tuple[Poly, ...] = ()
    sides: tuple[tuple[Poly, Poly], ...] = ()
    edge: bool = False


@dataclass(frozen=True)
class Unilateral:
    """A measure that stays at or above zero: a contact, a stop, a string.

    Attributes
    ----------
    name : str
        Of the connection, or of one part of a string.
    gap : polynomial
        Whose multiplier, while it is zero, is the force that keeps it there.
    slip, across : linear form in the rates, or None
        Rate of slip where there is friction; its multiplier is the friction. In space, along two directions.
    tangents : two vectors, or None
        These directions.
    static, kinetic, restitution : ball
        Coefficients.
    closes, opens : str
        What the events are called.
    rolls : bool
        Whether sticking is rolling.
    order : ball or None
        Place in the order of simultaneous impacts.
    tangential : ball
        Share of the slip that an impact turns back where friction suffices.
    law : str
        Of its impacts: "newton", "poisson" or "stronge".
    whole : str or None
        The connection whose forces are the sums of those of its corners, of which this is one.
    facets : tuple of Facet
        What a corner may meet of another shape; `gap` and `slip` are those of one of them.
    region : tuple of polynomial
        At or above zero as long as that one is what it may meet.
    first : bool
        Whether it meets the ends of edges: where two corners meet, that of the first shape takes the force.
    opposite : str or None
        In a guide without play the measure of the other side, whose gap is this one's below zero: one of both presses.
    listed : int
        Number of its connection in the description, by which impacts happen in order.
    """

    name: str
    gap: Poly
    slip: LinearForm | None = None
    static: Ball = ZERO
    kinetic: Ball = ZERO
    restitution: Ball = ZERO
    closes: str = "touch"
    opens: str = "lift-off"
    rolls: bool = False
    unit: str = "N"
    order: Ball | None = None
    across: LinearForm | None = None
    tangents: tuple[Sequence[Ball], Sequence[Ball]] | None = None
    law: ImpactLaw = "newton"
    tangential: Ball = ZERO
    whole: str | None = None
    facets: tuple[Facet, ...] = ()
    region: tuple[Poly, ...] = ()
    first: bool = True
    opposite: str | None = None
    listed: int = 0

    @property
    def slips(self) -> list[LinearForm]:
        """The rates of slip: none without friction, one in the plane, two in space."""
        return [line for line in (self.slip, self.across) if line is not None]

    @cached_property
    def normal(self) -> LinearForm:
        """The gradient of the gap: its rate as a linear form."""
        return gradient(self.gap)


@dataclass(frozen=True)
class Timed:
    """What a connection that begins or ends has in a table.

    Attributes
    ----------
    acts : bool
        Whether it acts at this time.
    coordinates : range
        Its own; while it does not act they stay as they are.
    unilateral, forces, works : range
        Numbers of its measures, forces and works, which have no effect while it does not act.
    """

    acts: bool
    coordinates: range
    unilateral: range
    forces: range
    works: range


@dataclass(frozen=True)
class Push:
    """What a blow is in a table.

    Attributes
    ----------
    momenta : mapping of int to polynomial
        What it adds to the momenta of coordinates (N s, N m s).
    components : mapping of str to polynomial
        The impulse by its components in space.
    """

    momenta: Mapping[int, Poly]
    components: Mapping[str, Poly]
