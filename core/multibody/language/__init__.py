"""What a client writes: bodies, places, connections and numbers, as frozen dataclasses."""
