"""Places and velocities that satisfy the connections, nearest to those of a sketch."""
