"""python3 tests/site.py [build/site]: checks the site that `make site` writes. Every internal link, anchor and picture exists;
no page loads anything from a network; every page of the documentation and every public function is there; the search index
has known terms; with chromium, the search finds them from a folder. The last line is "N passed, N failed"."""
import glob
import html.parser
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

SITE = sys.argv[1] if len(sys.argv) > 1 else "build/site"
LOADS = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src", "video": "src", "audio": "src", "embed": "src",
         "object": "data", "image": "href"}
passed = failed = 0


def check(right, text):
    global passed, failed
    passed, failed = passed + bool(right), failed + (not right)
    if not right:
        print("FAILED " + text)


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.path, self.ids, self.links, self.loads, self.styles = path, set(), [], [], []
        with open(path, encoding="utf-8") as file:
            self.text = file.read()
        self.feed(self.text)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.ids |= {found[name] for name in ("id", "name") if found.get(name)}
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        if LOADS.get(tag) in found and found[LOADS[tag]] and found.get("rel") not in ("canonical", "next", "prev", "index", "search"):
            self.loads.append(found[LOADS[tag]])
        if LOADS.get(tag) in found and found.get("rel") in ("next", "prev", "index", "search"):
            self.links.append(found[LOADS[tag]])
        self.styles.append(found.get("style") or "")


def target_of(page, link):
    """The file and the anchor to which a link leads; None if it leaves the site."""
    parts = urllib.parse.urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    path = urllib.parse.unquote(parts.path)
    return os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page, urllib.parse.unquote(parts.fragment)


def links_of(pages):
    for path, page in sorted(pages.items()):
        wrong = []
        for link in page.links + page.loads:
            at = target_of(path, link)
            if at is None:
                continue
            if not os.path.isfile(at[0]):
                wrong.append("no file for " + link)
            elif at[1] and at[0] in pages and at[1] not in pages[at[0]].ids:
                wrong.append("no anchor for " + link)
        check(not wrong, "%s: %s" % (path, "; ".join(sorted(set(wrong))[:5])))
        outside = [link for link in page.loads if re.match(r"(https?:)?//", link)] + re.findall(r"url\(\s*['\"]?(?:https?:)?//[^)]*", " ".join(
            page.styles + re.findall(r"<style.*?</style>", page.text, re.S)))
        check(not outside, "%s loads from a network: %s" % (path, outside[:3]))
    for path in glob.glob(os.path.join(SITE, "**", "*.css"), recursive=True):
        with open(path, encoding="utf-8") as file:
            check(not re.search(r"(url\(|@import)\s*['\"]?(https?:)?//", file.read()), path + " loads from a network")


def contents_of(pages):
    here = set(pages)
    for page in sorted(glob.glob("docs/*.md")) + ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"]:
        check(os.path.join(SITE, page[:-3] + ".html") in here, "no page for " + page)
    with open("dem.h", encoding="utf-8") as file:
        public = file.read().split("\n#endif /* DEM_H */")[0]
    anchors = set().union(*(page.ids for path, page in pages.items() if "/reference/" in path))
    for name in sorted(set(re.findall(r"^(?:DEM_API|DEM_INLINE|static inline) [\w ]+?[ *]+(dem_\w+)\(", public, re.M))):
        check(name in anchors, "no entry for " + name)
    gallery = pages[os.path.join(SITE, "gallery.html")]
    check(len([link for link in gallery.loads if "_images" in link]) == 24, "the gallery has not 24 pictures")
    first = " ".join(pages[os.path.join(SITE, "index.html")].links)
    for name in ("lab.html", "lesson.html", "docs/find.html", "gallery.html", "reference/index.html"):
        check(name in first, "the first page has no link to " + name)


def search_of():
    with open(os.path.join(SITE, "searchindex.js"), encoding="utf-8") as file:
        index = file.read()
    for term in ("dem_world_step", "dem_spheres_fill", "restitut", "hopper", "silo", "lifter", "stl", "numpi", "haff"):
        check(re.search(r"[\"\[,{ ]%s[\"\]:, ]" % term, index), "the search index has no term " + term)
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not browser:
        print("SKIP: no chromium (Debian package chromium): the search is not tried in a browser")
        return
    for words, page in (("dem_world_step", "reference/run.html"), ("angle of repose", "docs/how_to.html"), ("janssen", "docs/teaching.html")):
        folder = tempfile.mkdtemp()
        try:
            text = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                                   "--disable-background-networking", "--user-data-dir=" + folder, "--virtual-time-budget=10000", "--dump-dom",
                                   "file://%s/search.html?q=%s" % (os.path.abspath(SITE), urllib.parse.quote(words))],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=120).stdout.decode("utf-8", "replace")
        except subprocess.TimeoutExpired:
            text = ""
        shutil.rmtree(folder, ignore_errors=True)
        results = text[text.find('<ul class="search'):]
        check(page in results, "the search for \"%s\" in a browser does not find %s" % (words, page))


if not os.path.isdir(SITE):
    print("SKIP: no folder %s: run make site (Debian packages python3-sphinx, python3-myst-parser, furo)" % SITE)
    sys.exit(0)
all_pages = {path: Page(path) for path in glob.glob(os.path.join(SITE, "**", "*.html"), recursive=True)}
links_of(all_pages)
contents_of(all_pages)
search_of()
print("%d pages, %d links" % (len(all_pages), sum(len(page.links) for page in all_pages.values())))
print("%d passed, %d failed" % (passed, failed))
sys.exit(failed > 0)
