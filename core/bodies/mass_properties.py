"""Mass, centre of mass and inertia of a body; its principal moments and axes; whether matter can have them."""
