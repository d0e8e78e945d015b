"""Studies: one question with varied inputs, its members by design, and the statistics of their figures."""
