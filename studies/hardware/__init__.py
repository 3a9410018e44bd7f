"""A second caliper module as hardware: a truth that the compensation's structure does not contain."""
