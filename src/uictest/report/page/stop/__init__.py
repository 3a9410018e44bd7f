"""The part of a page that shows one stop."""
