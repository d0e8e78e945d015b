"""Motion through events: phases in which the states of contacts stay the same, and what ends each."""
