"""Feedback in English."""

from __future__ import annotations

from collections.abc import Mapping

ENGLISH: Mapping[str, str] = {
    # Verdicts
    "correct": "Correct.",
    "incorrect": "Not correct.",
    "missing-unit": "The unit is missing.",
    "not-gradable": "This answer cannot be graded: the tolerance is finer than the reference value is known.",
    "unreadable": "This answer cannot be read.",
    "figure-unknown": "This cannot be graded: the question has no such figure. Please tell your course staff.",
    "carried": "Not the expected value, but consistent with your earlier result.",
    "several": "Each of the following mistakes leads to this value.",
    "sensitive": "Compare {name}: the value itself is so close to a constant that it hides the error.",
    # Units
    "unit-malformed": "Write the unit as a product of powers of units, such as kg m^2/s^2.",
    "unit-unknown": "This unit is not known.",
    "unit-other-kind": "This unit belongs to a different quantity.",
    "unit-millisecond": "This unit belongs to a different quantity: ms is a millisecond, and metres per second are "
    "m/s.",
    "unit-with-offset": "Use a unit that starts at zero.",
    "unit-size": "This unit is too large or too small.",
    # Entries that cannot be read
    "direction-in-words": "Give the direction by the sign of the number, not in words.",
    "entry-empty": "The answer is empty.",
    "entry-malformed": "Write one number with its unit, such as 6.28 s.",
    "number-ambiguous": "{digits} can mean {whole} or {decimal}. Write {whole} or {padded}.",
    "number-malformed": "Write the number with one decimal mark and, if you separate thousands, groups of three "
    "digits.",
    "number-or-range": "{entry} can mean a calculation, a range, or a value with its uncertainty. Write the result as "
    "a single number.",
    "power-of-ten": "Write powers of ten with ^, such as 2*10^-3.",
    "quotient-unclear": "Use parentheses: 1/2π can mean 1/(2π) or (1/2)π.",
    "list-malformed": "Write a list of numbers such as [1.5; 2; 3].",
    "name-unknown": 'The problem has no quantity called "{name}". Its names are: {names}.',
    "name-from-zero": 'The problem has no quantity called "{name}": numbering starts at 1. Its names are: {names}.',
    "formula-malformed": "The formula is incomplete, or has a sign that is not allowed in it. Write * between factors.",
    "formula-not-expected": "A formula is not possible here: the answer is not a number.",
    "form-number": "Give one number.",
    "form-word": "Give one of the words of the problem, or true or false.",
    "form-list": "Give a list of {count} numbers.",
    "form-rows": "Give {rows} rows of {count} numbers.",
    # Formulas
    "formula-undefined": "The formula has no value for such numbers: check divisions, roots and logarithms.",
    "formula-not-judged": "A formula cannot be graded here. Give the number with its unit.",
    "formula-at-one-place": "The formula gives the right value for these numbers, but not for others.",
    "dimension": "Check the dimensions: the formula does not have the dimension of the quantity.",
    "dimension-terms": "Check the dimensions: quantities that are added or subtracted must have the same dimension.",
    "dimension-function": "Check the dimensions: functions such as sin and exp need a pure number.",
    "dimension-exponent": "Check the dimensions: an exponent must be a pure number.",
    # Samples
    "samples-until": "The samples are correct until t = {until:.3g} s.",
    "samples-separatrix": "The samples are correct until t = {until:.3g} s. Then they are lost at the separatrix: "
    "from t = {crossed:.3g} s they circle a different axis.",
    "samples-of-solver": "The samples are those of an adaptive method ({method}) with a tolerance of {tolerance:.0e}.",
    "samples-of-method": "The samples are those of {method} with a step of {step:.6g} s.",
    "samples-rounded": "The samples are correct to the digits given, which are fewer than the tolerance requires.",
    "axes-exchanged": "Axes {one} and {other} are exchanged.",
    "axes-order": "The axes are in the order {order}.",
    # Mistakes in any quantity
    "sign": "The magnitude is right. Check the sign, and which direction counts as positive.",
    "factor-2": "Too large by a factor of 2.",
    "factor-half": "Too small by a factor of 2.",
    "factor-2-pi": "Too large by a factor of 2π: distinguish radians from turns, and angular frequency from frequency.",
    "factor-1-over-2-pi": "Too small by a factor of 2π: distinguish radians from turns, and angular frequency from "
    "frequency.",
    "degrees": "Your value is in degrees. Give it in radians, or state the unit.",
    "rpm": "Your value is in revolutions per minute. Give it in rad/s, or state the unit.",
    "factor-1000": "Off by a factor of 1000: check the prefixes of the units.",
    "squared": "You gave the square of the quantity.",
    "root": "You gave the square root of the quantity.",
    "reciprocal": "You gave the reciprocal of the quantity. A period, for example, is the reciprocal of a frequency.",
    "permuted-axes": "The components are right, but in a different order. Keep the axes in which the body is given.",
    "transposed-rotation": "This is the inverse rotation. The rotation should take body axes to space axes.",
    "scalar-last": "The scalar part of a quaternion comes first here.",
    # Mass and inertia
    "inertia-about-another-point": "The moments of inertia are about a different point. A free body rotates about "
    "its centre of mass, wherever the origin is.",
    "parallel-axis": "Check the parallel axis theorem: going from the centre of mass to another point, its term is "
    "added once.",
    "products-of-inertia-sign": "Check the signs of the off-diagonal elements: I_xy is minus the integral of x y dm.",
    "repeated-points-dropped": "Every point mass counts, even where two of them coincide.",
    "shell-for-solid": "Check the shape: is the body solid, or a thin shell with its mass far from the axis?",
    "diameter-for-radius": "Check whether each length is a radius or a diameter.",
    # Rotation
    "space-axes": "These are the components along space axes. Euler's equations use components along the body's axes.",
    "samples-off-by-one": "The samples are right, but each is shifted by one time step.",
    "samples-rate-over-axial-moment": "The rate of precession is wrong: you divided the difference of the moments "
    "by the axial moment instead of the transverse moment.",
    "time-scaled": "The motion is right, but too fast or too slow. Check the unit of time and the factors in the rate.",
    "period-for-flip-interval": "Distinguish the period from the interval between flips: a flip is half a period.",
    "body-for-space-rate": "Distinguish two rates: that of the angular velocity in the body, and that of the body's "
    "axis in space.",
    "cones-exchanged": "Check which two directions the angle is between: angular velocity and angular momentum differ.",
    "rate-over-axial-moment": "Divide the difference of the moments by the transverse moment, as Euler's equations "
    "for the transverse components show.",
    "moments-exchanged": "Check which moment of inertia belongs to the axis of symmetry.",
    "symmetric-formula": "You used the formula for a symmetric body, but the three moments of inertia differ.",
    "ellipticity-root-of-moments": "The axis ratio is not the square root of the ratio of the moments, which are "
    "proportional to 2a² and a² + c².",
    "ellipticity-quotient-of-moments": "The axis ratio is the square root of (1 + e)/(1 - e), with e the relative "
    "difference of the moments.",
    "flattening-for-asymmetry": "Distinguish the flattening, which describes the shape, from the asymmetry of the "
    "moments of inertia.",
    "solar-for-sidereal-day": "Distinguish solar from sidereal days: the Earth rotates once in a sidereal day.",
    "extreme-axis-unstable": "Rotation about the axis of the largest or smallest moment is stable: a small "
    "disturbance stays small.",
    "middle-axis-stable": "Rotation about the axis of the middle moment is unstable: a small disturbance grows.",
    "real-for-imaginary": "Check the sign of the squared eigenvalue: it decides whether the eigenvalues are real or "
    "imaginary.",
    "euler-second-equation": "Check the signs: Euler's equations follow from one another by cyclic exchange of 1, 2 "
    "and 3.",
    "derivative-for-state": "Euler's method adds the step times the derivative to the previous value.",
    "step-left-out": "The derivative must be multiplied by the step.",
    # Scenes
    "inertia-left-out": "Include the moments of inertia: a pulley with mass has different tensions on its two "
    "sides, and a rolling body moves more slowly than a sliding one.",
    "shafts-do-not-turn": "The shafts rotate as the string unwinds, which takes part of the work of gravity.",
    "hoop-for-solid-shaft": "Check the moment of inertia of the shafts: solid cylinder or thin tube?",
    "rod-inertia-about-end": "M l²/3 is the moment of inertia about an end of the rod. Start from the moment about "
    "its centre, and use the parallel axis theorem.",
    "rod-depth-and-inertia": "Check the dimensions of the potential energy, the similar triangles that give the "
    "depth of the centre at release, and the point about which you take the moment of inertia.",
    "rod-depth": "Check the dimensions of the potential energy, and the similar triangles that give the depth of "
    "the centre.",
    "rod-without-own-rotation": "The rod also rotates while its centre swings: include its own moment of inertia.",
    "masses-exchanged": "Check which mass is on which side.",
    "sine-for-cosine": "Check the component of the weight along each slope, and from which line its angle is measured.",
    "calculator-in-radians": "The sines do not match these angles. Is your calculator set to radians instead of "
    "degrees?",
    "without-gravity": "Check the dimensions: the gravitational acceleration is missing.",
}
