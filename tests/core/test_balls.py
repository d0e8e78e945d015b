"""The precision of the ball arithmetic holds inside a block, for one thread at a time."""

import ast
from pathlib import Path
from threading import Thread

import pytest
from flint import arb, ctx, fmpq, fmpz

from core.balls import as_text, precision, raised


def test_precision_is_put_back() -> None:
    before = ctx.prec
    with precision(400):
        assert ctx.prec == 400
        with precision(1000):
            assert ctx.prec == 1000
        assert ctx.prec == 400
    assert ctx.prec == before
    with pytest.raises(ZeroDivisionError), precision(400):
        raise ZeroDivisionError
    assert ctx.prec == before


def test_another_thread_waits() -> None:
    seen = []

    def compute() -> None:
        with precision(200):
            seen.append(ctx.prec)

    other = Thread(target=compute)
    with precision(400):
        other.start()
        other.join(0.1)
        assert seen == []
        assert ctx.prec == 400
    other.join()
    assert seen == [200]


@pytest.mark.parametrize(
    ("number", "text"),
    [("0.25", "0.25"), ("0", "0"), ("-1234.5", "-1.23e+03"), ("2e400", "2.00e+400"), ("3e-400", "3.00e-400")],
)
def test_balls_as_text(number: str, text: str) -> None:
    with precision(400):
        assert as_text(arb(number), 3) == text


@pytest.mark.parametrize("exponent", [0, 1, 2, 3, 7, 20])
@pytest.mark.parametrize("middle", ["0", "1e-30", "0.5", "-0.5"])
def test_a_whole_power_of_a_ball_around_zero_holds_the_powers_of_its_numbers(middle: str, exponent: int) -> None:
    ball = arb(middle, 1e-3)
    for found in (raised(ball, exponent), raised(ball, arb(exponent))):
        assert found.is_finite()
        for share in (-1, 0, 1):
            assert found.contains((arb(fmpq(fmpz(share), fmpz(1024))) + arb(middle).mid()) ** exponent)


def test_other_powers_are_those_of_the_library() -> None:
    assert raised(arb(2), arb("0.5")).contains(arb(2).sqrt())
    assert (raised(arb(2), -3) * 8).contains(1)


def test_no_square_of_a_ball_is_left_to_the_library() -> None:
    """Its square of a ball around zero is no number; in these packages what is squared may be one."""
    core = Path(__file__).parents[2] / "core"
    left = [
        f"{path.relative_to(core)}:{node.lineno}"
        for folder in ("scenes", "multibody/table")
        for path in sorted((core / folder).glob("*.py"))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)
        if isinstance(node.right, ast.Constant) and not isinstance(node.left, ast.Constant)
    ]
    assert left == []
