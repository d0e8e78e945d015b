"""From a description to the table of quadratics: coordinates of bodies, rows of connections, forces and works."""
