"""A finished sweep put into words, tables and sheets: what its page, workbook and Markdown say."""
