"""Formulas as text, as LaTeX and as MathML."""
