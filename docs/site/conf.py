# README: the settings of Sphinx for the site, and links from every name of dem.h in code to its entry in the reference.
# build.py runs Sphinx with this file on the copies of the pages that it has made.
import json
import os
import re

project = "dem.h"
author = copyright = "the dem.h authors"
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "dem.h"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = html_show_copyright = html_show_sphinx = False
smartquotes = False                     # "--" in a page is an option of a program
html_show_search_summary = False        # a browser cannot fetch the summaries from a folder
highlight_language = "text"
pygments_style = pygments_dark_style = "tango"      # Debian's furo has no dark colours for the page
myst_heading_anchors = 6
suppress_warnings = ["myst.header"]

PARTS = re.compile(r"<a\b.*?</a>|<(code|pre)\b.*?</\1>", re.S)
NAME = re.compile(r"<[^>]*>|\b((?:dem_|DEM_)\w+)(\.\w+)?")


def link_names(app, page, template, context, doctree):
    """Links names of dem.h in code to the reference, and gives its entries plain anchors such as #dem_world_step."""
    with open(os.path.join(app.srcdir, "names.json")) as file:
        names = json.load(file)

    def link(found):
        name, field = found.group(1), found.group(2) or ""
        place = names.get(name + field if name and name + field in names else name) if name else None
        if not place:
            return found.group(0)
        target, anchor = place.split("#")
        uri = app.builder.get_relative_uri(page, target[:-len(".html")]) if target != page + ".html" else ""
        shown = found.group(0) if name + field in names else name
        return '<a class="name" href="%s#%s">%s</a>%s' % (uri, anchor, shown, found.group(0)[len(shown):])
    if context.get("body"):
        body = PARTS.sub(lambda part: NAME.sub(link, part.group(0)) if part.group(1) else part.group(0), context["body"])
        context["body"] = re.sub(r'(<dt class="sig[^>]* id="c\.([\w.]+)">)', r'\1<span id="\2"></span>', body)


def setup(app):
    app.connect("html-page-context", link_names)
