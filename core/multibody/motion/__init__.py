"""Models of the motion of a part, from rest to the Taylor series, and the whole scene put together."""
