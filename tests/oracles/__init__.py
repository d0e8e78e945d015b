"""Independent references: slow, of any precision, sharing no code and no algorithm with what they judge."""
