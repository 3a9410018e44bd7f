"""What the rows of a sweep amount to: counts, maps, trends, sensitivities, frontiers."""
