"""Ratings turned into statements: the published tables, and what is right for the design."""
