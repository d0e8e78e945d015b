"""A second engine for described scenes, the plainest there can be, which shares with the first the definitions alone.

All bodies move in maximal coordinates, rows come from differentiating the definition of each connection, accelerations
from least squares, motions from an explicit Runge-Kutta method with projection, events from its dense output, shares of
loads from a linear programme, and impacts from trying all combinations.
"""
