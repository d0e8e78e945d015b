"""Forces that are formulas of time, places and rates: their graphs, and the Taylor coefficients of their values."""
