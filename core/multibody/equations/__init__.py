"""The equations of a table at the start and about a state: assembly, accelerations, expansion, compiled arrays."""
