"""Where a scene can rest, and between which values of a number it does."""
