"""The settings of Sphinx for the site (build.py)."""

import os

project = "Touchstone"
author = "The Touchstone authors"
copyright = "The Touchstone authors, MIT licence"  # noqa: A001: the name that Sphinx reads
release = version = os.environ["TOUCHSTONE_VERSION"]

extensions = ["myst_parser", "sphinx_copybutton", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 4
source_suffix = {".md": "markdown"}
suppress_warnings = ["myst.header", "misc.highlighting_failure"]

html_theme = "furo"
html_title = "Touchstone"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}
pygments_style = "friendly"
copybutton_selector = "div.highlight-sh pre, div.highlight-python pre, div.highlight-cpp pre, div.highlight-cmake pre"

breathe_projects = {"touchstone": os.environ["TOUCHSTONE_DOXYGEN"]}
breathe_default_project = "touchstone"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"


def setup(app):
    """Formulas are set by KaTeX, which is part of the site (static/katex)."""

    def formula(is_display):
        def visit(writer, node):
            tag = "div" if is_display else "span"
            kind = "formula display" if is_display else "formula"
            text = writer.encode(node.astext()).strip()
            writer.body.append(f'<{tag} class="{kind}">{text}</{tag}>')
            from docutils import nodes

            raise nodes.SkipNode

        return visit

    app.add_html_math_renderer("katex", (formula(False), None), (formula(True), None))
    app.config.html_math_renderer = "katex"
    app.add_css_file("katex/katex.min.css")
    app.add_js_file("katex/katex.min.js")
