"""Stops of two variants that met the same noise, and the differences between them."""
