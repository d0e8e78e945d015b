"""Integration: systems, methods, the policy that chooses among them, and `solve`. It knows no physics."""
