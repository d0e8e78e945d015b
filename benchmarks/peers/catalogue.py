"""Everyone that is measured, and everyone that is not, with the reason."""

from __future__ import annotations

from benchmarks.peers import closed_forms, compiled_integrators, engines, scipy_integrators
from benchmarks.peers.peer import Peer

PEERS: tuple[Peer, ...] = (
    *closed_forms.PEERS,
    *compiled_integrators.PEERS,
    *scipy_integrators.PEERS,
    *engines.PEERS,
)

LEFT_OUT = {
    "DifferentialEquations.jl": "needs Julia, which pip does not install",
    "Newton, MuJoCo Warp, Genesis, Brax": "single precision, made for many bodies on a graphics processor",
    "torchdiffeq, torchode": "step in Python over PyTorch tensors, a gigabyte for what diffrax shows",
    "pyodesys, JiTCODE": "hand the same equations to SciPy or to the SUNDIALS solvers, whose cost they share",
    "Basilisk, Exudyn, DART, Pinocchio": "engines of MuJoCo's and Drake's kind: fixed or controlled Runge-Kutta steps",
    "REBOUND, Tudat": "integrate orbits; their rotating bodies are torque models that a free body does not need",
}
"""Considered and not measured."""
