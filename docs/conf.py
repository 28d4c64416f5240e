"""Sphinx configuration: the pages beside this file, and the public Python."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from fakesss import __version__

project = "fakesss"
author = "the fakesss maintainers"
project_copyright = "the fakesss maintainers, GPL-3.0-or-later"
release = version = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = f"fakesss {__version__}"
myst_heading_anchors = 3
autodoc_typehints = "description"
