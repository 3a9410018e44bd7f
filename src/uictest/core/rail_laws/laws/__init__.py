"""One module for each law of the rail, with its `LAW`."""
