"""Every measure, declared once: each module here has a tuple `MEASURES`, which the registry finds."""
