"""Results on a terminal: a table where a person reads, lines elsewhere."""
