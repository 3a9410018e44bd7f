"""The part of a page that shows a sweep."""
