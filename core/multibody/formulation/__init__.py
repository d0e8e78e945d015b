"""The equations of a scene as people write them: coordinates, Lagrangian, equations of motion, what is conserved."""
