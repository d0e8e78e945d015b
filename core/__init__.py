"""The mechanics: bodies, systems, their motion, and how right each answer is. Knows nothing of HTTP."""
