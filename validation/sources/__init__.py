"""The public sources: each module defines one, named `SOURCE`."""
