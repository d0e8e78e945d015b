"""The branches of a free rotation as models: what each is called, and why it holds."""

from __future__ import annotations

from core.rotation.closed_form.circulation import REST, SEPARATRIX, STEADY
from core.rotation.closed_form.constants_of_motion import ConstantsOfMotion
from core.systems.system import Model

NAME = "torque-free rigid body"


def model_of(motion: ConstantsOfMotion, apart: tuple[bool, bool], line: bool, unstable: str | None) -> Model:
    """Return the branch of the solution that holds.

    Parameters
    ----------
    motion : ConstantsOfMotion
    apart : pair of bool
        Whether the moments, ascending, differ from the next.
    line : bool
        Whether the body is a line of matter.
    unstable : str or None
        Why a steady spin is unstable, if it is.
    """
    equal = [not differ for differ in apart]
    if motion.regime == REST:
        return Model(NAME, "rest", "the angular velocity is zero", 0)
    if motion.regime == STEADY:
        return steady_model(any(equal) and not line, all(equal), unstable)
    if motion.regime == SEPARATRIX:
        return Model(
            NAME,
            "separatrix",
            "L^2 = 2 E I_middle exactly: the motion tends to the middle axis, by hyperbolic functions",
            1,
        )
    if any(equal):
        return Model(
            NAME, "regular precession", "two moments are equal: sine and cosine about the axis of the third", 1
        )
    parameter = f"parameter m = {motion.m:.6g}" if motion.m1 > 1e-3 else f"1 - m = {motion.m1:.3g}"
    return triaxial_model(motion.circled == 2, parameter)


def steady_model(symmetric: bool, spherical: bool, unstable: str | None) -> Model:
    """Return the model of a constant angular velocity.

    Parameters
    ----------
    symmetric, spherical : bool
        Whether at least two moments are equal, and whether all are.
    unstable : str or None
        Why the spin is unstable, if it is.
    """
    if unstable is not None:
        return Model(NAME, "unstable steady rotation", unstable, 0)
    if spherical:
        why = "the three moments are equal, so every axis is principal"
    else:
        why = f"the spin lies along {'the axis of symmetry' if symmetric else 'a principal axis'}"
    return Model(NAME, "steady rotation", f"{why}: nothing accelerates", 0)


def triaxial_model(largest: bool, parameter: str | None = None) -> Model:
    """Return the branch that holds where three moments differ and the axis of the largest, or smallest, is circled.

    Parameters
    ----------
    largest : bool
    parameter : str, optional
        The parameter of the elliptic functions, where it is known as a number.
    """
    regime = f"circulation about the axis of {'largest' if largest else 'smallest'} moment"
    why = f"three moments differ and L^2 {'>' if largest else '<'} 2 E I_middle: Jacobian elliptic functions"
    return Model(NAME, regime, why if parameter is None else f"{why}, {parameter}", 1)
