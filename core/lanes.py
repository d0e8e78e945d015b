"""Eight doubles at a time, in compiled code.

A value of the type `LANES` is eight doubles, and +, -, *, / and `core.compiled.fma` act on each of them. A function
compiled for numbers, such as those of `core.double_double`, is compiled for eight numbers by being called with them.
Machines with narrower registers take two or four instructions instead of one. Numba vectorises loops by itself, but not
sums, whose order it may not change, nor loops as short as those of small mechanical systems.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any, cast

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

from core.arrays import Floats

WIDTH = 8


_VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)


# Numba's packages have no type annotations.
_Type: Any = types.Type
_Model: Any = models.PrimitiveModel
_declared: Any = cgutils.get_or_insert_function
_lowered: Any = lower_builtin


class Lanes(_Type):  # type: ignore[misc]
    """The type of eight doubles."""

    def __init__(self) -> None:
        super().__init__(name="Lanes")


LANES = Lanes()


@register_model(Lanes)
class _LanesModel(_Model):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)


def _define(function: Any, instruction: str, count: int) -> None:
    """Let an operator act on lanes by an instruction."""

    def type_of(context: Any) -> Any:
        def typer(*arguments: Any) -> Any:
            return LANES if all(isinstance(kind, Lanes) for kind in arguments) else None

        return (lambda a: typer(a)) if count == 1 else (lambda a, b: typer(a, b))

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return getattr(builder, instruction)(*arguments)

    type_callable(function)(type_of)
    _lowered(function, *[Lanes] * count)(generate)


_define(operator.add, "fadd", 2)
_define(operator.sub, "fsub", 2)
_define(operator.mul, "fmul", 2)
_define(operator.truediv, "fdiv", 2)
_define(operator.neg, "fneg", 1)


def fused(builder: Any, arguments: Any) -> Any:
    """Return the instruction a*b + c, rounded once, for lanes."""
    kind = ir.FunctionType(_VECTOR, [_VECTOR] * 3)
    return builder.call(_declared(builder.module, kind, f"llvm.fma.v{WIDTH}f64"), arguments)


def _pointer(context: Any, builder: Any, kind: Any, array: Any, index: Any) -> Any:
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


def _require_flat(kind: Any) -> None:
    if not (isinstance(kind, types.Array) and kind.layout == "C" and kind.dtype == types.float64):
        raise TypeError(f"lanes are those of a contiguous array of doubles, not of {kind}")


@intrinsic
def _lanes_at(typing_context: Any, array: Any, index: Any) -> Any:
    _require_flat(array)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        read = builder.load(_pointer(context, builder, signature.args[0], *arguments))
        read.align = 8
        return read

    return LANES(array, types.intp), generate


@intrinsic
def _put_lanes(typing_context: Any, array: Any, index: Any, value: Any) -> Any:
    _require_flat(array)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        written = builder.store(arguments[2], _pointer(context, builder, signature.args[0], *arguments[:2]))
        written.align = 8
        return context.get_dummy_value()

    return types.void(array, types.intp, LANES), generate


@intrinsic
def _alike(typing_context: Any, number: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), arguments[0], ir.IntType(32)(0))
        mask = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
        return builder.shuffle_vector(first, ir.Constant(_VECTOR, ir.Undefined), mask)

    return LANES(types.float64), generate


# For a type checker eight doubles are one, because the same functions take both.
lanes_at = cast(Callable[[Floats, int], float], _lanes_at)
"""The eight doubles of a contiguous array, read as if it were of one dimension, from an index on; not checked."""

put_lanes = cast(Callable[[Floats, int, float], None], _put_lanes)
"""Write eight doubles to a contiguous array from an index on; not checked."""

alike = cast(Callable[[float], float], _alike)
"""Eight times the same double."""
