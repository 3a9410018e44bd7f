"""Series of stops in every format: tables, lines, JUnit, Markdown, the page."""
