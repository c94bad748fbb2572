# Sphinx: tools/docs/build runs it over the staged sources (make/stage.py), with warnings as errors.
import re
from pathlib import Path

here = Path(__file__).parent
version = re.search(r"project\(hamel VERSION ([0-9.]+)", (here / "../../CMakeLists.txt").read_text())[1]

project = "hamel"
author = "the authors of hamel"
release = version
copyright = "the authors of hamel, BSD-3-Clause"  # noqa: A001
extensions = ["myst_parser", "breathe"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["readme/**", "generated/**"]
highlight_language = "none"

myst_heading_anchors = 4
suppress_warnings = [
    "myst.header",  # the level of a README's headings depends on the page that includes it
    "misc.highlighting_failure",  # for … in a line of C++
]

breathe_default_project = "hamel"
breathe_projects = {"hamel": ""}  # set below, when the output folder exists
breathe_domain_by_extension = {"hpp": "cpp"}
breathe_show_include = False
cpp_index_common_prefix = ["hamel::"]

html_theme = "furo"
html_title = "hamel"
html_static_path = [str(here / "static")]
html_css_files = ["hamel.css"]
html_copy_source = False
html_show_sourcelink = False

_EQUATION = re.compile(r"\(M(\d+)\)")


def _number_equations(app, pagename, templatename, context, doctree):
    """Makes (M16) a link to its equation."""
    if pagename == "method":
        app.add_css_file("katex/katex.css")
    body = context.get("body")
    if not body or "(M" not in body:
        return
    there = "" if pagename == "method" else app.builder.get_relative_uri(pagename, "method")

    def link(match):
        return f'<a class="equation" href="{there}#M{match[1]}">(M{match[1]})</a>'

    # Equations (make/mathematics.py makes their anchors), code blocks, links, headings and tags are not changed.
    parts = re.split(r"(<figure class=\"equations\">.*?</figure>|<pre>.*?</pre>|<a .*?</a>|<h\d.*?</h\d>|<[^>]+>)", body, flags=re.S)
    for i, part in enumerate(parts):
        if not part.startswith("<"):
            parts[i] = _EQUATION.sub(link, part)
    context["body"] = "".join(parts)


def _break_paths(app, pagename, templatename, context, doctree):
    """Lets inline code break behind a slash, so that a narrow column does not break a path within a word."""
    if context.get("body"):
        inline = re.compile(r'<span class="pre">[^<]*</span>')
        context["body"] = inline.sub(lambda match: match[0].replace("/", "/<wbr>").replace("</<wbr>", "</"), context["body"])


def setup(app):
    app.config.html_static_path.append(str(Path(app.srcdir).parent / "typeset"))  # KaTeX's style and fonts
    app.connect("html-page-context", _number_equations)
    app.connect("html-page-context", _break_paths)
    app.config.breathe_projects["hamel"] = str(Path(app.srcdir).parent / "doxygen" / "xml")
