"""The closed form of the angular velocity: set-up and sampling."""
