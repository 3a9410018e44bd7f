"""Recorded stops: their files, the conditions that they are judged under, and the run that judges them."""
