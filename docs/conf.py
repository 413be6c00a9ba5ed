"""How Sphinx builds the documentation: `./dev docs`, without a network and without warnings."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "site"))

import pages  # noqa: E402  (the folder above)

project = "Kerf"
author = "The Kerf developers"
copyright = author
version = release = pages.version()

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["site", "include", "benchlog", "manual/pictures"]
master_doc = "index"

myst_heading_anchors = 4
myst_links_external_new_tab = False
suppress_warnings = ["myst.header"]  # the manual has pages whose first section is of the third level

autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": False}
autosummary_generate = False
numpydoc_show_class_members = False
numpydoc_validation_checks = set()

html_theme = "furo"
html_title = f"Kerf {version}"
html_static_path = []
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
templates_path = []
pygments_style = "friendly"


def setup(app):
    """Pages that are made from the sources, and links to files of the repository."""
    app.connect("builder-inited", pages.write_generated)
    app.connect("source-read", pages.link_to_repository)
    app.connect("autodoc-process-docstring", pages.title_without_section)
