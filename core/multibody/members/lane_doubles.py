"""The motion of eight members at a time in doubles: the operations of `motion.series.advance` in lanes."""

from __future__ import annotations

from core.arrays import Floats
from core.compiled import kernel
from core.double_double import dd_add_d, dd_mul
from core.lanes import WIDTH, alike, lanes_at, put_lanes
from core.multibody.algebra.pair_arrays import gathered
from core.multibody.members.lane_motion import following
from core.multibody.members.lane_series import lane_changes, lane_coefficients
from core.multibody.members.lane_space import LaneSpace, lane_entries, lane_inverse
from core.multibody.members.lane_table import LaneForm
from core.multibody.motion.series import changes_of, moved_by, moved_state


@kernel()
def _expand(form: LaneForm, space: LaneSpace, tolerance: float) -> None:
    """Fill in the Taylor coefficients."""
    lane_changes(form, space, 1)
    lane_coefficients(form, space, 0)


@kernel()
def _move(form: LaneForm, space: LaneSpace) -> None:
    """Move the states of all lanes by their steps."""
    series, h, of_power, order = space.series[0], lanes_at(space.h, 0), WIDTH * form.series, space.series.shape[1] - 1
    q, q_tail, v, v_tail = space.q[0], space.q[1], space.v[0], space.v[1]
    for at in range(0, WIDTH * form.n, WIDTH):
        moved, rate = changes_of(series, at, of_power, order, h)
        own = lanes_at(q, at), lanes_at(q_tail, at), lanes_at(v, at), lanes_at(v_tail, at)
        qh, ql, vh, vl = moved_state(*own, lanes_at(series, 2 * of_power + at), moved, rate, h)
        put_lanes(q, at, qh)
        put_lanes(q_tail, at, ql)
        put_lanes(v, at, vh)
        put_lanes(v_tail, at, vl)


@kernel()
def _invert(form: LaneForm, space: LaneSpace) -> None:
    """Fill in the entries of W and the columns of the inverses at the places."""
    lane_entries(form, space)
    lane_inverse(form, space)


@kernel()
def _sample(path: Floats, time: float, begun: float, begun_tail: float, q: Floats, v: Floats) -> None:
    """Evaluate the series of a lane, as `motion.series.sampled` does."""
    moved_by(path[0].T, (time - begun) - begun_tail, q[:, 0], v[:, 0])


@kernel()
def add_corrections(form: LaneForm, space: LaneSpace, state: Floats, measures_only: bool) -> None:
    """Add to places, or to rates, what undoes the residuals."""
    n, m, columns, residual = form.n, form.m, space.columns[0], space.residual
    of_tails = WIDTH * n
    size = n + m
    for i in range(n):
        total = alike(0.0)
        for r in range(m):
            if not measures_only or form.held[r] == 1:
                rest = lanes_at(residual, 2 * WIDTH * r) + lanes_at(residual, 2 * WIDTH * r + WIDTH)
                total = total + lanes_at(columns, WIDTH * ((n + r) * size + i)) * rest
        sh, sl = dd_add_d(lanes_at(state, WIDTH * i), lanes_at(state, of_tails + WIDTH * i), total)
        put_lanes(state, WIDTH * i, sh)
        put_lanes(state, of_tails + WIDTH * i, sl)


@kernel(forceinline=True)
def add_residual(residual: Floats, r: int, ah: float, al: float, bh: float, bl: float) -> None:
    """Subtract a product from the residual of a row."""
    at = 2 * WIDTH * r
    sh, sl = gathered(lanes_at(residual, at), lanes_at(residual, at + WIDTH), -ah, -al, bh, bl)
    put_lanes(residual, at, sh)
    put_lanes(residual, at + WIDTH, sl)


@kernel()
def _correct(form: LaneForm, space: LaneSpace) -> None:
    """Put the places back on the measures, and the rates onto the rows there."""
    x, q, v, residual, tail = space.x, space.q, space.v, space.residual, WIDTH * form.n
    for r in range(form.m):
        for plane in range(2):
            put_lanes(residual, WIDTH * (2 * r + plane), -lanes_at(x, WIDTH * (form.offset + 2 * r + plane)))
    _add_lines(form, space, q)
    for p in range(form.varying.shape[0]):
        e, i = form.varying[p, 0], WIDTH * form.varying[p, 2]
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        if form.held[r] == 1:
            ph, pl = dd_mul(lanes_at(q, i), lanes_at(q, tail + i), lanes_at(q, j), lanes_at(q, tail + j))
            at = WIDTH * (form.slopes + 2 * p)
            half = alike(0.5)
            add_residual(residual, r, half * lanes_at(x, at), half * lanes_at(x, at + WIDTH), ph, pl)
    add_corrections(form, space, q, True)
    lane_entries(form, space)
    for r in range(form.m):
        for plane in range(2):
            put_lanes(residual, WIDTH * (2 * r + plane), lanes_at(x, WIDTH * (form.rate + 2 * r + plane)))
    _add_lines(form, space, v)
    for p in range(form.varying.shape[0]):
        e, i = form.varying[p, 0], WIDTH * form.varying[p, 2]
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        ph, pl = dd_mul(lanes_at(q, i), lanes_at(q, tail + i), lanes_at(v, j), lanes_at(v, tail + j))
        at = WIDTH * (form.slopes + 2 * p)
        add_residual(residual, r, lanes_at(x, at), lanes_at(x, at + WIDTH), ph, pl)
    add_corrections(form, space, v, False)


@kernel()
def _add_lines(form: LaneForm, space: LaneSpace, state: Floats) -> None:
    """Subtract from the residuals what the constant entries of W give with places or rates."""
    x, residual, tail = space.x, space.residual, WIDTH * form.n
    for e in range(form.lines_at.shape[0]):
        r, j = form.lines_at[e, 0], WIDTH * form.lines_at[e, 1]
        high, low = lanes_at(x, WIDTH * (form.lines + 2 * e)), lanes_at(x, WIDTH * (form.lines + 2 * e + 1))
        add_residual(residual, r, high, low, lanes_at(state, j), lanes_at(state, tail + j))


follow_in_doubles = following(1, _expand, _move, _invert, _correct, _sample)
