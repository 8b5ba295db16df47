"""README: python3 build.py OUT writes the documentation as a static site into the folder OUT: `make site`.

It copies the pages to OUT-source with links to source files rewritten, makes the reference, the gallery and the first page,
runs Sphinx, adds the source files that pages link to, and checks the result (tests/site.py). Nothing is downloaded."""
import html
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\(([^)\s#]+)(#[^)\s]*)?\)")
AS_IS = (".html", ".png", ".ipynb", ".stl", ".pgm")         # copied without a page around them


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


class Site:
    def __init__(self, out):
        self.out, self.stage = os.path.abspath(out), os.path.abspath(out) + "-source"
        self.sources = ["examples/web/pages/lab.html", "examples/web/pages/lesson.html", "dem.h"]   # to be shown
        docs = sorted("docs/" + name for name in os.listdir(os.path.join(ROOT, "docs")) if name.endswith(".md"))
        self.pages = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"] + docs

    def place(self, path):
        """Where the site shows a file or folder of the repository."""
        if path not in self.sources:
            self.sources.append(path)
        if os.path.isdir(os.path.join(ROOT, path)):
            return "source/%s/index.html" % path
        return "source/" + path + ("" if path.endswith(AS_IS) else ".html")

    def linked(self, text, page):
        """The text of a page; links to files that are no pages of the site lead to their copies."""
        folder, code = os.path.dirname(page), False

        def link(found):
            shown, target, anchor = found.group(1), found.group(2), found.group(3) or ""
            path = os.path.normpath(os.path.join(folder, target))
            if re.match("[a-z]+:", target) or path in self.pages or not os.path.exists(os.path.join(ROOT, path)):
                return found.group(0)
            return '<a href="%s%s">%s</a>' % (os.path.relpath(self.place(path), folder or "."), anchor, shown)
        lines = text.split("\n")
        for k, line in enumerate(lines):
            code ^= line.lstrip().startswith("```")
            lines[k] = line if code else LINK.sub(link, line)
        return "\n".join(lines)

    def replay(self, command):
        """The replay of a program: one that is in build/out, or a new one if the program is there and quick. Else: ""."""
        name, run = command.split()[0], command.split()[1:]
        build, folder = os.path.join(ROOT, "build"), os.path.join(self.out + "-replays", name)
        program = os.path.join(build, name)

        def files():
            paths = [os.path.join(base, file) for base in (folder, os.path.join(folder, "build", "out", name), os.path.join(build, "out", name))
                     for file in (name + ".html", "replay.html")]
            return [path for path in paths if os.path.exists(path) and os.path.getsize(path) < 30e6]
        if run and os.access(program, os.X_OK) and not any(os.path.getmtime(path) > os.path.getmtime(program) for path in files()):
            os.makedirs(folder, exist_ok=True)
            try:
                subprocess.run([program] + run, cwd=folder, timeout=30, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               env=dict(os.environ, OMP_NUM_THREADS="1"))
            except (subprocess.SubprocessError, OSError):
                print("the gallery links to a page instead of a replay: build/%s fails or takes more than 30 s" % command)
        for path in files():
            os.makedirs(os.path.join(self.stage, "extra", "replays"), exist_ok=True)
            shutil.copy(path, os.path.join(self.stage, "extra", "replays", name + ".html"))
            return "replays/" + name + ".html"
        return ""

    def gallery(self):
        rows = [[cell.strip() for cell in line.split("|")] for line in read("docs/site/gallery.txt").split("\n")[1:] if line]
        text = ("# Gallery\n\nThese %d pictures come from the pages and replays of dem.h. A picture opens its replay, if there is one, or else "
                "its page.\n\n````{container} gallery\n" % len(rows))
        for image, page, command, caption in rows:
            replay = self.replay(command) if command else ""
            more = "[page](%s)" % page + (', <a href="%s">replay</a>' % replay if replay else "")
            text += "```{figure} docs/images/%s.png\n:target: %s\n:alt: %s\n\n%s\n%s\n```\n" % (
                image, replay or page[:-3] + ".html", json.dumps(caption), caption, more)
        return text + "````\n"

    def index(self):
        """The first page: lists of pages by the sections of docs/README.md."""
        listed = {"README", "docs/find", "docs/README"}

        def tree(title, pages):
            lines = [re.sub("(.*)=(.*)", lambda found: "%s <%s>" % (found.group(1).replace("-", " "), found.group(2)), page) for page in pages]
            return "```{toctree}\n:hidden:\n:caption: %s\n\n%s\n```\n" % (title, "\n".join(lines))
        sections = ""
        for part in read("docs/README.md").split("\n## ")[1:]:
            pages = [os.path.normpath("docs/" + name) for name in re.findall(r"\]\(([\w./]+)\.md\)", part)]
            pages = [name for name in dict.fromkeys(pages) if name not in listed and name not in ("CHANGELOG", "CONTRIBUTING")]
            listed.update(pages)
            sections += tree(part.split("\n")[0], pages) if pages else ""
        rest = [page[5:-3] for page in self.pages if page.startswith("docs/") and page[:-3] not in listed]
        sections += tree("More", ["docs/" + name for name in rest]) if rest else ""
        text = read("docs/site/index.md").replace("@ sections", sections)
        return re.sub(r"^@ (\w+): (.*)$", lambda found: tree(found.group(1), found.group(2).split()), text, flags=re.M)

    def prepare(self):
        for folder in (self.out, self.stage):
            shutil.rmtree(folder, ignore_errors=True)
        for page in self.pages:
            write(os.path.join(self.stage, page), self.linked(read(page), page))
        shutil.copytree(os.path.join(ROOT, "docs", "images"), os.path.join(self.stage, "docs", "images"))
        write(os.path.join(self.stage, "gallery.md"), self.gallery())
        write(os.path.join(self.stage, "index.md"), self.index())
        import reference
        write(os.path.join(self.stage, "names.json"), json.dumps(reference.write(self.stage, read("dem.h"))))

    def show(self, path):
        """Adds a source file or folder to the site."""
        from pygments import highlight
        from pygments.formatters import HtmlFormatter
        from pygments.lexers import TextLexer, get_lexer_for_filename
        from pygments.util import ClassNotFound
        full, place = os.path.join(ROOT, path), os.path.join(self.out, self.place(path))
        up = os.path.relpath(self.out, os.path.dirname(place))
        if os.path.isdir(full):
            names = [name for name in sorted(os.listdir(full)) if not name.startswith((".", "__"))]
            links = [(os.path.relpath(self.place(path + "/" + name), "source/" + path), name) for name in names]
            body = "<ul>%s</ul>" % "".join('<li><a href="%s">%s</a></li>' % link for link in links)
        elif path.endswith(AS_IS):
            os.makedirs(os.path.dirname(place), exist_ok=True)
            shutil.copy(full, place)
            return
        else:
            text, note, style = read(path), "", HtmlFormatter()
            if path == "dem.h":
                style = HtmlFormatter(linenos="inline", lineanchors="line")
                shutil.copy(full, place[:-len("html")] + "txt")
                text = text[:text.index("\n#endif /* DEM_H */")]
                note = '<p>The public part. The <a href="dem.h.txt">whole file</a> has the implementation, too.</p>'
            try:                                            # long files, and src/, stay without colours: they would be several times as long
                plain = path.startswith("src/") or len(text) > 2e5 and path != "dem.h"
                lexer = TextLexer(stripnl=False) if plain else get_lexer_for_filename(path, stripnl=False)
            except ClassNotFound:
                lexer = TextLexer(stripnl=False)
            body = note + highlight(text, lexer, style)
        title = html.escape(path)
        write(place, '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, '
              'initial-scale=1"><title>%s</title><link rel="stylesheet" href="%s/_static/pygments.css"><link rel="stylesheet" href="'
              '%s/_static/site.css"></head><body class="source" data-theme="light"><p><a href="%s/index.html">dem.h</a> / %s</p>%s</body>'
              '</html>\n' % (title, up, up, up, title, body))

    def make(self):
        from sphinx.cmd.build import main
        started = time.time()
        self.prepare()
        code = main(["-q", "-j", "1", "-b", "html", "-c", HERE, "-d", os.path.join(self.stage, "trees"), self.stage, self.out])
        if code:
            return code
        if os.path.exists(os.path.join(self.stage, "extra")):
            shutil.copytree(os.path.join(self.stage, "extra"), self.out, dirs_exist_ok=True)
        for path in self.sources:                           # folders add their files to the list
            self.show(path)
        pages = sum(name.endswith(".html") for _, _, names in os.walk(self.out) for name in names)
        print("%s/index.html: %d pages, %d of them of the documentation, in %.0f s" % (os.path.relpath(self.out), pages, len(self.pages) +
              len(os.listdir(os.path.join(self.stage, "reference"))) + 2, time.time() - started), flush=True)
        return subprocess.call([sys.executable, os.path.join(ROOT, "tests", "site.py"), self.out])


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.path.insert(0, HERE)
    missing = [name for name in ("sphinx", "myst_parser", "furo") if not importlib.util.find_spec(name)]
    if missing:
        print("SKIP: make site: Python has no module %s (Debian packages python3-sphinx, python3-myst-parser, furo)" % ", ".join(missing))
        sys.exit(0)
    sys.exit(Site(sys.argv[1] if len(sys.argv) > 1 else "build/site").make())
