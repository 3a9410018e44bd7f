"""Summarise the rows of a sweep: counts, maps, trends, histograms, sensitivities, frontiers."""
