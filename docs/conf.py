"""The pages as a site: `python -m sphinx -W docs site`, with the extra `docs`."""

from importlib import metadata

project = "uictest"
author = "the uictest developers"
release = metadata.version(project)
extensions = ["myst_parser"]
exclude_patterns = ["tools"]
myst_heading_anchors = 4  # the anchors that GitHub and GitLab give to headings
html_theme = "furo"
html_title = f"{project} {release}"
html_show_copyright = False
