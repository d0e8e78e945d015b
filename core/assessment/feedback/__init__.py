"""Feedback for those who submitted an answer, in several languages: one catalogue of texts for each."""
