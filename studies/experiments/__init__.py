"""The studies: each module defines one, named `STUDY`."""
