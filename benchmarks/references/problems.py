"""Published problems with their sources, as described scenes, and the figures that are published of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any


@dataclass(frozen=True)
class Problem:
    """A published problem.

    Attributes
    ----------
    name, source : str
    scene : dict
        As a client describes it.
    time : str
        At which the figures are, a decimal (s).
    figures : tuple of str
        Coordinates, such as ``bob.x``, ``rod.angle`` and ``bob.vx``.
    published : mapping of str to str
        Figures of the source, by coordinate, with the digits that it prints.
    remark : str
    """

    name: str
    source: str
    scene: Mapping[str, Any]
    time: str
    figures: tuple[str, ...]
    published: Mapping[str, str] = field(default_factory=dict)
    remark: str = ""


def attracting(bodies: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Return bodies that attract one another with a constant of one."""
    pairs = combinations(bodies, 2)
    return {
        "bodies": dict(bodies),
        "connections": [{"kind": "gravitation", "a": a, "b": b, "constant": 1} for a, b in pairs],
    }


STARS = "abcdefg"
PLEIADES_PLACES = ((3, 3), (3, -3), (-1, 2), (-3, 0), (2, 0), (-2, -4), (2, 4))
PLEIADES_RATES = ((0, 0), (0, 0), (0, 0), (0, "-1.25"), (0, 1), ("1.75", 0), ("-1.5", 0))
PLEIADES_PUBLISHED = (
    ("0.3706139143970502", "-3.943437585517392"),
    ("3.237284092057233", "-3.271380973972550"),
    ("-3.222559032418324", "5.225081843456543"),
    ("0.6597091455775310", "-2.590612434977470"),
    ("0.3425581707156584", "1.198213693392275"),
    ("1.562172101400631", "-0.2429682344935824"),
    ("-0.7003092922212495", "1.091449240428980"),
)
"""Coordinates of the seven stars at t = 3."""

PLEIADES = Problem(
    "Pleiades: seven stars in the plane",
    "E. Hairer, S. P. Nørsett and G. Wanner, Solving Ordinary Differential Equations I, section II.10; figures of the "
    "Test Set for Initial Value Problem Solvers, release 2.4",
    attracting(
        {
            star: {"mass": i + 1, "at": list(PLEIADES_PLACES[i]), "velocity": list(PLEIADES_RATES[i])}
            for i, star in enumerate(STARS)
        }
    ),
    "3",
    tuple(f"{star}.{axis}" for star in STARS for axis in "xy"),
    {f"{star}.{axis}": PLEIADES_PUBLISHED[i][k] for i, star in enumerate(STARS) for k, axis in enumerate("xy")},
)

ARENSTORF = Problem(
    "Arenstorf's orbit about Earth and Moon",
    "R. F. Arenstorf, American Journal of Mathematics 85 (1963); start and period as in E. Hairer, S. P. Nørsett and "
    "G. Wanner, Solving Ordinary Differential Equations I, section II.0",
    {
        "let": {"mu": "0.012277471"},
        "bodies": {"ship": {"mass": 1, "at": ["0.994", 0], "velocity": [0, "-2.00158510637908252240537862224"]}},
        "connections": [
            {"kind": "inverse-square", "a": "ship", "b": ["-mu", 0], "strength": "1 - mu"},
            {"kind": "inverse-square", "a": "ship", "b": ["1 - mu", 0], "strength": "mu"},
            {"kind": "spinning-frame", "rate": 1, "about": "normal"},
        ],
    },
    "17.0652165601579625588917206249",
    ("ship.x", "ship.y"),
    {"ship.x": "0.994", "ship.y": "0"},
    "The published period: the orbit closes, as it says, to the digits of its start.",
)

BURRAU = Problem(
    "Three bodies of masses 3, 4 and 5 at rest in a right triangle",
    "C. Burrau, Astronomische Nachrichten 195 (1913); V. Szebehely and C. F. Peters, Astronomical Journal 72 (1967)",
    attracting(
        {
            "three": {"mass": 3, "at": [1, 3], "velocity": [0, 0]},
            "four": {"mass": 4, "at": [-2, -1], "velocity": [0, 0]},
            "five": {"mass": 5, "at": [1, -1], "velocity": [0, 0]},
        }
    ),
    "10",
    ("three.x", "three.y", "four.x", "four.y", "five.x", "five.y"),
    {},
    "Published as figures and tables of few digits.",
)

EIGHT = Problem(
    "Three equal masses on one figure of eight",
    "A. Chenciner and R. Montgomery, Annals of Mathematics 152 (2000), with the start of C. Simó",
    attracting(
        {
            "a": {"mass": 1, "at": ["0.97000436", "-0.24308753"], "velocity": ["0.93240737/2", "0.86473146/2"]},
            "b": {"mass": 1, "at": ["-0.97000436", "0.24308753"], "velocity": ["0.93240737/2", "0.86473146/2"]},
            "c": {"mass": 1, "at": [0, 0], "velocity": ["-0.93240737", "-0.86473146"]},
        }
    ),
    "6.32591398",
    ("a.x", "a.y", "c.x", "c.y"),
    {"a.x": "0.97000436", "a.y": "-0.24308753", "c.x": "0", "c.y": "0"},
    "The published period. The start has eight digits, and so closes the orbit to about eight.",
)

SHAKEN_X, SHAKEN_Y = "sqrt(1 - (sin(10*t)/10)^2)", "sin(10*t)/10"
"""The wheel of the car on the bumpy road."""

CAR_AXIS = Problem(
    "Car axis on a bumpy road",
    "S. Schneider, dissertation, Aachen 1994; figures of the Test Set for Initial Value Problem Solvers, release 2.4",
    {
        "gravity": [0, -1],
        "bodies": {
            "left": {"mass": "5e-4", "at": [0, "0.5"], "velocity": ["-0.5", 0]},
            "right": {"mass": "5e-4", "at": [1, "0.5"], "velocity": ["-0.5", 0]},
        },
        "connections": [
            {"kind": "spring", "a": "left", "b": [0, 0], "stiffness": 1, "rest_length": "0.5"},
            {"kind": "spring", "a": "right", "b": [SHAKEN_X, SHAKEN_Y], "stiffness": 1, "rest_length": "0.5"},
            {"kind": "rod", "name": "chassis", "a": "left", "b": "right", "length": 1},
            {"kind": "relation", "name": "joint", "of": f"{SHAKEN_X}*left.x + {SHAKEN_Y}*left.y"},
        ],
    },
    "3",
    ("left.x", "left.y", "right.x", "right.y", "left.vx", "left.vy", "right.vx", "right.vy"),
    {
        "left.x": "0.0493455784275402809122",
        "left.y": "0.496989460230171153861",
        "right.x": "1.04174252488542151681",
        "right.y": "0.373911027265361256927",
        "left.vx": "-0.0770583684040972357970",
        "left.vy": "0.00744686658723778553466",
        "right.vx": "0.0175568157537232222276",
        "right.vy": "0.770341043779251976443",
    },
)

SQUEEZER_LENGTHS = {
    **{"xa": "-0.06934", "ya": "-0.00227", "xb": "-0.03635", "yb": "0.03273", "xc": "0.014", "yc": "0.072"},
    **{"d": "0.028", "da": "0.0115", "e": "0.02", "ea": "0.01421", "rr": "0.007", "ra": "0.00092"},
    **{"ss": "0.035", "sa": "0.01874", "sb": "0.01043", "sc": "0.018", "sd": "0.02"},
    **{"zt": "0.04", "ta": "0.02308", "tb": "0.00916", "u": "0.04", "ua": "0.01228", "ub": "0.00449"},
    **{"zf": "0.02", "fa": "0.01421"},
}
SQUEEZER_ANGLES = {
    "beta": "-0.0617138900142764496358948458001",
    "gamma": "0.455279819163070380255912382449",
    "phi": "0.222668390165885884674473185609",
    "delta": "0.487364979543842550225598953530",
    "omega": "-0.222668390165885884674473185609",
    "epsilon": "1.23054744454982119249735015568",
}
SQUEEZER_MASSES = {
    **{"k1": ("0.04325", "2.194e-6"), "k2": ("0.00365", "4.410e-7"), "k3": ("0.02373", "5.255e-6")},
    **{"k4": ("0.00706", "5.667e-7"), "k5": ("0.07050", "1.169e-5"), "k6": ("0.00706", "5.667e-7")},
    **{"k7": ("0.05498", "1.912e-5")},
}


def _link(name: str, start: tuple[str, str], turn: str, along: str, across: str, **places: list[str]) -> dict[str, Any]:
    """Return a link whose centre lies so far along its axis and across it from a point."""
    x, y = start
    at = [
        f"{x} + ({along})*cos({turn}) - ({across})*sin({turn})",
        f"{y} + ({along})*sin({turn}) + ({across})*cos({turn})",
    ]
    mass, inertia = SQUEEZER_MASSES[name]
    return {"mass": mass, "inertia": inertia, "at": at, "angle": turn, "places": places}


def _pin(a: str, b: Any) -> dict[str, Any]:
    return {"kind": "pin", "a": a, "b": b}


SQUEEZER = Problem(
    "Andrews' squeezing mechanism",
    "W. Schiehlen (editor), Multibody Systems Handbook, 1990; E. Hairer and G. Wanner, Solving Ordinary Differential "
    "Equations II, section VII.7; figures of the Test Set for Initial Value Problem Solvers, release 2.4",
    {
        "let": {**SQUEEZER_LENGTHS, **SQUEEZER_ANGLES},
        "bodies": {
            "k1": _link("k1", ("0", "0"), "beta", "ra", "0", o=["-ra", "0"], e=["rr - ra", "0"]),
            "k2": _link("k2", ("rr*cos(beta)", "rr*sin(beta)"), "beta", "-da", "0", e=["da", "0"], f=["da - d", "0"]),
            "k3": _link(
                *("k3", ("xb", "yb"), "gamma", "sb", "-sa"),
                b=["-sb", "sa"],
                f=["-sb", "sa - ss"],
                s=["sd - sb", "sa - sc"],
            ),
            "k4": _link(
                *("k4", ("xa + zt*cos(delta)", "ya + zt*sin(delta)"), "phi + delta", "0", "ea - e"),
                h=["0", "e - ea"],
                f=["0", "-ea"],
            ),
            "k5": _link("k5", ("xa", "ya"), "delta", "ta", "tb", a=["-ta", "-tb"], h=["zt - ta", "-tb"]),
            "k6": _link(
                *("k6", ("xa + u*sin(epsilon)", "ya - u*cos(epsilon)"), "omega + epsilon", "zf - fa", "0"),
                g=["fa - zf", "0"],
                f=["fa", "0"],
            ),
            "k7": _link("k7", ("xa", "ya"), "epsilon", "-ub", "-ua", a=["ub", "ua"], g=["ub", "ua - u"]),
        },
        "connections": [
            *(_pin("k1.o", [0, 0]), _pin("k1.e", "k2.e"), _pin("k3.b", ["xb", "yb"]), _pin("k5.a", ["xa", "ya"])),
            *(_pin("k7.a", ["xa", "ya"]), _pin("k4.h", "k5.h"), _pin("k6.g", "k7.g")),
            *(_pin("k2.f", f"{link}.f") for link in ("k3", "k4", "k6")),
            {"kind": "spring", "a": "k3.s", "b": ["xc", "yc"], "stiffness": 4530, "rest_length": "0.07785"},
            {"kind": "torque", "body": "k1", "torque": "0.033"},
        ],
    },
    "0.03",
    ("k1.angle", "k3.angle", "k5.angle", "k7.angle"),
    {
        "k1.angle": "15.81077119629904",
        "k3.angle": "0.04082224013073101",
        "k5.angle": "0.5244099658805304",
        "k7.angle": "1.048080741042263",
    },
)

HEAVY_TOP = Problem(
    "Heavy top of Géradin and Cardona",
    "M. Géradin and A. Cardona, Flexible Multibody Dynamics, 2001; data as in O. Brüls, A. Cardona and M. Arnold, "
    "Mechanism and Machine Theory 48 (2012), and in the documentation of Kynema",
    {
        "gravity": [0, 0, "-9.81"],
        "bodies": {
            "top": {
                "mass": 15,
                "moments": ["0.234375", "0.234375", "0.46875"],
                "at": [0, 1, 0],
                "axes": [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
                "angular_velocity": ["-4.61538", 0, 150],
                "places": {"tip": [0, 0, 1]},
            }
        },
        "connections": [{"kind": "ball-joint", "a": "top.tip", "b": [0, 0, 0]}],
    },
    "2",
    ("top.x", "top.y", "top.z"),
    {},
    "Published as plots and errors against finer runs.",
)

BOX_MASS = "7700*0.5*0.06^2"
BOX_INERTIA = f"{BOX_MASS}*(0.5^2 + 0.06^2)/12"
"""Of a box of 0.5 m by 0.06 m by 0.06 m, with the density that the library's `BodyBox` has if none is given."""


def _box(x: str) -> dict[str, Any]:
    places = {"a": ["-0.25", 0], "b": ["0.25", 0]}
    return {"mass": BOX_MASS, "inertia": BOX_INERTIA, "at": [x, 0], "places": places}


MODELICA_PENDULUM = Problem(
    "Double pendulum of Modelica's library",
    "Modelica Standard Library, Modelica.Mechanics.MultiBody.Examples.Elementary.DoublePendulum, which stops at 3 s",
    {
        "gravity": [0, "-9.81"],
        "bodies": {"box1": _box("0.25"), "box2": _box("0.75")},
        "connections": [
            _pin("box1.a", [0, 0]),
            {"kind": "damper", "a": "box1", "measure": "turn", "coefficient": "0.1"},
            _pin("box2.a", "box1.b"),
        ],
    },
    "3",
    ("box1.x", "box1.y", "box2.x", "box2.y"),
    {},
    "The library has no figures of its own: its regression tests compare releases.",
)

CHRONO_PENDULUM = Problem(
    "Pendulum about an oblique axis, from Chrono's tests",
    "Project Chrono, data/testing/joints: test_Revolute_Case02.adm, with the positions that ADAMS computes",
    {
        "gravity": [0, 0, "-9.80665"],
        "bodies": {
            "pendulum": {
                "mass": 1,
                "moments": ["0.04", "0.1", "0.1"],
                "at": [3, 2, 3],
                "axes": [[1, 0, 0], [0, "sqrt(2)/2", "-sqrt(2)/2"], [0, "sqrt(2)/2", "sqrt(2)/2"]],
                "places": {"joint": [-2, 0, 0]},
            }
        },
        "connections": [{"kind": "pin", "a": "pendulum.joint", "b": [1, 2, 3], "axis": [0, 1, 1]}],
    },
    "2.5",
    ("pendulum.x", "pendulum.y", "pendulum.z"),
    {"pendulum.x": "-0.8468880", "pendulum.y": "2.542680", "pendulum.z": "2.457320"},
)

CHRONO_BALL_JOINT = Problem(
    "Pendulum on a ball joint, from Chrono's tests",
    "Project Chrono, data/testing/joints: test_Spherical_Case02.adm, with the positions that ADAMS computes",
    {
        "gravity": [0, 0, "-9.80665"],
        "bodies": CHRONO_PENDULUM.scene["bodies"],
        "connections": [{"kind": "ball-joint", "a": "pendulum.joint", "b": [1, 2, 3]}],
    },
    "2.5",
    ("pendulum.x", "pendulum.z"),
    {"pendulum.x": "0.7344940", "pendulum.z": "1.017700"},
)

BRICARD_PLACES = {"A": (0, 0, 0), "B": (1, 0, 0), "C": (1, -1, 0), "D": (1, -1, 1), "E": (0, -1, 1), "F": (0, 0, 1)}
BRICARD_AXES = {"A": (0, 1, 0), "B": (0, 0, 1), "C": (1, 0, 0), "D": (0, 1, 0), "E": (0, 0, 1), "F": (1, 0, 0)}


def _rod(ends: str) -> dict[str, Any]:
    """Return a rod of 1 m with a cross section of 0.1 m by 0.1 m between two of the joints."""
    first, last = (BRICARD_PLACES[end] for end in ends)
    along = next(k for k in range(3) if first[k] != last[k])
    half = [f"({last[k]} - ({first[k]}))/2" for k in range(3)]
    return {
        "mass": 1,
        "moments": ["0.02/12" if k == along else "1.01/12" for k in range(3)],
        "at": [f"({first[k]} + {last[k]})/2".replace("+ -", "- ") for k in range(3)],
        "places": {ends[0]: [f"-{x}" for x in half], ends[1]: half},
    }


def _hinge(a: str, b: Any, joint: str) -> dict[str, Any]:
    return {"kind": "pin", "a": f"{a}.{joint}", "b": b, "axis": list(BRICARD_AXES[joint])}


BRICARD = Problem(
    "Bricard's mechanism",
    "IFToMM's library of benchmark problems, A04; data as in RehabEngGroup's MBSbenchmarksInOpenSim, joints as in M. "
    "Taylor's example for Chrono",
    {
        "gravity": [0, "-9.81", 0],
        "bodies": {name.lower(): _rod(name) for name in ("AB", "BC", "CD", "DE", "EF")},
        "connections": [
            _hinge("ab", list(BRICARD_PLACES["A"]), "A"),
            *(
                _hinge(a, f"{b}.{j}", j)
                for a, b, j in zip(("bc", "cd", "de", "ef"), ("ab", "bc", "cd", "de"), "BCDE", strict=True)
            ),
            _hinge("ef", list(BRICARD_PLACES["F"]), "F"),
        ],
    },
    "1",
    ("ab.x", "ab.z", "bc.x", "bc.y", "bc.z", "cd.x", "cd.y", "cd.z"),
    {},
    "Six hinges hold five rods redundantly, and leave one degree of freedom. Published as plots over 10 s.",
)

PROBLEMS = (
    *(PLEIADES, ARENSTORF, BURRAU, EIGHT, CAR_AXIS, SQUEEZER),
    *(HEAVY_TOP, MODELICA_PENDULUM, CHRONO_PENDULUM, CHRONO_BALL_JOINT, BRICARD),
)
