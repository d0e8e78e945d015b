"""Assessment: a submitted answer compared with the computed one, and the mistakes that explain the difference."""
