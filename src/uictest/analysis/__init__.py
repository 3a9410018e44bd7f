"""What many results show: summaries of sweeps, comparisons, agreement."""
