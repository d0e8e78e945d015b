"""The free rigid body: its motion, precession, stability and energy surface."""
