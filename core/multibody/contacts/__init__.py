"""Contacts that touch: which of them stick, slide or open, with what forces, and impacts."""
