"""The precision of the ball arithmetic holds inside a block, for one thread at a time."""

from threading import Thread

import pytest
from flint import arb, ctx

from core.balls import as_text, precision


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
