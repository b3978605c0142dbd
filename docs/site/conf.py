"""Sphinx's configuration of the documentation site; pages.py makes the pages."""

import pathlib
import re

here = pathlib.Path(__file__).resolve().parent
top = here.parents[1]

project = "FisherHill"
author = copyright = "FisherHill authors"
release = re.search(r"VERSION (\S+) ", (top / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
extensions = ["myst_parser"]
html_theme = "furo"
html_title = f"FisherHill {release}"
html_show_sphinx = html_show_copyright = html_copy_source = False
highlight_language = "none"
smartquotes = False
myst_heading_anchors = 4
