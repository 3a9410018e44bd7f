"""Recorded stops of validation and series files, run beside their simulations."""
