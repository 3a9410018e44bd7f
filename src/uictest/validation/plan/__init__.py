"""What a validation file says: recorded stops and the scenarios that simulate them."""
