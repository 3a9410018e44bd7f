"""Every measure of a series: each module declares its own as MEASURES."""
