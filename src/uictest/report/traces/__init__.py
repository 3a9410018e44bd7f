"""What the plots of a stop are drawn from."""
