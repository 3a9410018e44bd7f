"""Data of real trains: recordings read and judged, and the friction of the rail fitted to them."""
