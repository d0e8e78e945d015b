"""The mechanics: bodies, systems, their motion, and how accurate each answer is. Knows nothing of HTTP."""
