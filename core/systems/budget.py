"""How much one question may cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from core.quantities import Quantity, check

Count = Annotated[int, Quantity("1", at_least=1)]


@dataclass(frozen=True)
class Budget:
    """The largest counts allowed to one question.

    Counts are the same on every machine, which times are not: what is refused here is refused everywhere.

    Attributes
    ----------
    evaluations : int
        Of the equation of motion, or of the flows of its parts.
    samples : int
        Rows of the answer.
    members : int
        Questions of a study.
    audited : bool
        Whether answers about described scenes are checked against the description before they are given.
    """

    evaluations: Count = 20_000_000
    samples: Count = 1_000_000
    members: Count = 10_000_000
    audited: bool = True

    def __post_init__(self) -> None:
        check(self)
