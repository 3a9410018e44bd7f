"""Criteria applied to measures: verdicts of stops, of series, and the result document."""
