"""How Sphinx builds the documentation: `make docs`, without network."""

import sys
from pathlib import Path

from crossview import __version__

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

project = "crossview"
author = "The crossview developers"
project_copyright = "2026, The crossview developers"
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "_ext.mathml",
    "_ext.written",
]
exclude_patterns = ["_ext"]
suppress_warnings = [
    "myst.header",  # one page is included in another, with its headings one level down
    "ref.python",  # what is exported by a room and by crossview is the same
]

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
html_math_renderer = "mathml"

autodoc_default_options = {"members": True, "imported-members": True}
autodoc_member_order = "groupwise"
autodoc_typehints = "none"  # the docstrings say more: shapes and units
autodoc_class_signature = "mixed"
napoleon_google_docstring = False
napoleon_use_rtype = False
python_use_unqualified_type_names = True
default_role = "py:obj"  # a link where there is something of that name
autodoc_preserve_defaults = True
add_module_names = False
toc_object_entries_show_parents = "hide"

html_theme = "sphinx_book_theme"  # that of PyVista's documentation
html_title = f"crossview {release}"
html_static_path = ["_static"]
html_css_files = ["crossview.css"]
html_copy_source = html_show_sourcelink = False
html_theme_options = {
    "show_navbar_depth": 1,
    "navbar_persistent": [],  # the sidebar has the search
    "show_toc_level": 2,
    "use_download_button": False,
    "use_fullscreen_button": False,
}
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
