"""README: makes the pages of the reference from the public part of dem.h: one page per part, an entry per function, struct,
enum and type, with its comment and an anchor (#dem_world_step). build.py calls it. The parser is that of
examples/python/make.py; this file adds the order of the parts and the layout of comments."""
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "python"))
import make as parser   # noqa: E402

TOKEN = re.compile(r"^/\*(?s:.*?)\*/|^(?:typedef|struct|enum|DEM_API|DEM_INLINE|static inline|static const|#define) .*", re.M)
KINDS = [("function", r"(?:DEM_API|DEM_INLINE|static inline) [\w ]+?[ *]+(dem_\w+)\("), ("struct", r"(?:typedef )?struct (dem_\w+) \{"),
         ("enum", r"typedef enum (dem_\w+) \{"), ("call", r"typedef .*\(\*(dem_\w+)\)\("), ("opaque", r"typedef struct (dem_\w+) \1;"),
         ("constant", r"enum \{ (DEM_\w+)"), ("macro", r"#define (DEM_(?:REAL|R)\b|DEM_\w+(?=\(NAME))"), ("real", r"typedef DEM_REAL (dem_real);"),
         ("zero", r"static const (dem_\w+) DEM_\w+_ZERO")]
TAGS = "api|law-rows|scene|machine|run|record|manual"
UNIT = re.compile(parser.UNIT + r"(?=$|[,;.:])")


def escape(text):
    return re.sub(r"([\\*`|_<>\[\]])", r"\\\1", text)


def inline(text):
    """A line of a comment as reStructuredText: names and words in backticks as code, names of parts and pages as links."""
    def piece(word):
        if word.startswith(">>") and re.fullmatch(TAGS, word[2:]):
            return r"\ :doc:`%s <%s>`\ " % (word[2:], word[2:])
        if word.startswith("docs/"):
            return r"\ :doc:`%s </%s>`\ " % (word, word[:-3])
        return r"\ ``%s``\ " % word.strip("`")
    parts = re.split(r"(`[^`]+`|\b(?:dem_|DEM_)\w+(?:\.\w+)?|>>[a-z-]+|\bdocs/\w+\.md\b|\b[a-z]+(?:\.[a-z]+)?(?:_[a-z0-9]+)+\b)",
                     re.sub(r"\s+", " ", text.strip()))
    return "".join(piece(part) if k % 2 else escape(part) for k, part in enumerate(parts))


def capital(text):
    return text[:1].upper() + text[1:] if re.match(r"[a-z]+[ ,]", text) else text


def table(rows, widths, head=None):
    out = [".. list-table::", "   :widths: " + widths] + (["   :header-rows: 1"] if head else []) + [""]
    for row in ([head] if head else []) + rows:
        for k, cell in enumerate(row):
            out.append(("   * - " if k == 0 else "     - ") + cell)
    return out + [""]


def is_code(lines):
    return any(re.search(r";\s*(//.*)?$|\{$|^ *#\w", line) for line in lines)


def block(lines):
    """Indented lines of a comment: code, a table of terms, or text with its line breaks."""
    indent = min(len(line) - len(line.lstrip()) for line in lines if line)
    lines = [line[indent:] for line in lines]
    code, rows = is_code(lines), []
    for line in lines:
        term, more = re.match(r"(\S.*?) {2,}(\S.*)$", line), re.match(r" {1,3}(\S+) {3,}(\S.*)$", line)
        if term:
            rows.append([term.group(1), term.group(2)])
        elif more and rows:
            rows[-1] = [rows[-1][0] + " " + more.group(1), rows[-1][1] + " " + more.group(2)]
        elif re.match(r" {4,}\S", line) and rows:
            rows[-1][1] += " " + line.strip()
        else:
            rows, code = [], code or None
            break
    if rows and not code:
        return table([[inline(cell) for cell in row] for row in rows], "25 75")
    return [".. code-block:: " + ("c" if code else "text"), ""] + ["   " + line for line in lines] + [""]


def prose(comment):
    """A comment of dem.h as lines of reStructuredText."""
    lines = re.sub(r"^/\* ?|(\s*Tests: [^()]*(\([^()]*\)[^()]*)*)?\s*\*/$", "", comment).split("\n")
    lines = [lines[0].strip()] + [re.sub("^   ", "", line.rstrip()) for line in lines[1:]]
    blocks = []                                             # kind, lines
    for line in lines:
        last = blocks[-1][0] if blocks else ""
        heading = re.match(r"--- (.*) ---$", line)
        kind = ("" if not line.strip() else "heading" if heading else "item" if line.startswith("- ") or line.startswith("  ") and last == "item"
                else "code" if line.startswith("  ") else "text")
        if not blocks or kind != last or kind in ("heading", "item") and not line.startswith("  "):
            blocks.append((kind, [heading.group(1) if heading else line]))
        else:
            blocks[-1][1].append(line)
    k = 1
    while k < len(blocks) - 1:                              # empty lines within code
        if [b[0] for b in blocks[k - 1:k + 2]] == ["code", "", "code"] and is_code(blocks[k - 1][1]) == is_code(blocks[k + 1][1]):
            blocks[k - 1:k + 2] = [("code", blocks[k - 1][1] + blocks[k][1] + blocks[k + 1][1])]
        else:
            k += 1
    out = []
    for kind, text in blocks:
        if kind == "code":
            out += block(text)
        elif kind == "heading":
            out += [inline(text[0]), "-"*len(text[0]), ""]
        elif kind:
            text = " ".join(text)
            out += ["- " + inline(text[2:]) if kind == "item" else inline(text), ""]
    return out


class Reference(parser.Header):
    def __init__(self, text):
        super().__init__(text.replace("\nstatic inline dem_world *dem_world_create(const dem_world_desc *desc);",
                                      "\nDEM_API dem_world *dem_world_create(const dem_world_desc *desc);"))
        self.titles = dict(re.findall(r"^       >>(\S+) +(.*)$", text[:text.index("*/")], re.M))
        self.manual = re.search(r"   >>manual\n.*?-\n(.*?)\n\*/", text, re.S).group(1)
        self.parts, self.names, self.first = [], {}, {}     # [tag, lines]; name: page#anchor; name of a function: its sentence
        begin, end = text.index("\n#ifndef DEM_H\n"), text.index("\n#endif /* DEM_H */")
        self.source, doc, section, seen = text, "", None, set()
        for token in TOKEN.finditer(text, begin, end):
            word, after = token.group(0), text[token.end():token.end() + 3]
            tag = re.search(r"\n   >>(\S+)\n", word)
            if tag:
                self.lines = []
                self.parts.append([tag.group(1), self.lines])
                self.lines += prose("/* " + re.sub(r"\n   -+ ?(?=\*/)", " ", word[tag.end():]).strip())
            elif word.startswith("/* ----"):
                title, _, doc = word[7:].partition("----")
                section = title.strip()
                section, doc = section[0].upper() + section[1:], doc.replace("*/", "").strip()
                if doc:
                    self.put(section, prose("/* " + doc + " */"))
                    section = None
            elif word.startswith("/*") and (after.startswith("\n\n") or after.startswith("\n/*")):
                self.put(section, prose(word))              # about all that follow
                section, doc = None, ""
            elif word.startswith("/*"):
                doc = word
            else:
                for kind, pattern in KINDS:
                    found = re.match(pattern, word)
                    if found and (kind, found.group(1)) not in seen and not (kind == "opaque" and found.group(1) in self.structs):
                        seen.add((kind, found.group(1)))
                        line = text.count("\n", 0, token.start()) + 1
                        behind = re.search(r"[;}]\s*(/\*.*\*/)$", word) if kind != "function" else None
                        self.put(section, self.entry(kind, found.group(1), behind.group(1) if behind else doc, token.start(), line))
                        section = None
                        break
        lost = [name for name in [f.name for f in self.functions] + list(self.structs) + list(self.enums) + list(self.calls)
                if name not in self.names]
        if lost:
            sys.exit("reference.py: no entry for " + ", ".join(lost))

    def put(self, section, lines):
        self.lines += ([section, "-"*len(section), ""] if section else []) + lines

    def name(self, name, anchor=None):
        self.names[name] = "reference/%s.html#%s" % (self.parts[-1][0], anchor or name)

    def entry(self, kind, name, doc, at, line):
        """The lines of one entry."""
        text = self.source[at:]
        if kind == "zero":                                  # the constant of a struct
            constant = re.search(r"DEM_\w+(?=_ZERO)", text).group(0)
            self.name(constant, name)
            return ["   The constant ``%s`` has every field 0." % constant, ""]
        if kind == "constant":
            values = re.findall(r"(DEM_\w+) = (\d+)", text[:text.index("}")])
            for value, _ in values:
                self.name(value)
            return sum([[".. c:enumerator:: %s = %s" % value, ""] for value in values], []) + ["   " + part for part in prose(doc)] + [""]
        self.name(name)
        body = ["`line %d of dem.h <../source/dem.h.html#line-%d>`__" % (line, line), ""]
        sign = name
        if kind == "function":
            sign = re.match(r"(?:DEM_API|DEM_INLINE|static inline) (.*?\))\s*[;{]", text, re.S).group(1)
            self.first[name] = parser.clean(doc).split(". ")[0].rstrip(".")
        elif kind == "call":
            sign = re.match(r"typedef (.*?);", text, re.S).group(1)
        elif kind == "macro":
            sign = re.match(r"#define (\w+(?:\(.*?\))?)", text).group(1)
        elif kind == "struct":
            body = self.fields(name) + body
        elif kind == "enum":
            rows = [[self.anchor(v, v), str(number), inline(capital(note)) or r"\ "] for v, number, note in self.enums[name][0]]
            body = table(rows, "40 10 50", ["Constant", "Value", "Meaning"]) + body
        word = {"function": "function", "struct": "struct", "enum": "enum", "macro": "macro"}.get(kind, "type")
        return [".. c:%s:: %s" % (word, re.sub(r"\s+", " ", sign)), ""] + ["   " + part for part in prose(doc) + body] + [""]

    def anchor(self, anchor, shown):
        self.name(anchor)
        return ":raw-html:`<span id=\"%s\"></span>`\\ ``%s``" % (anchor, shown)

    def fields(self, struct):
        rows = []
        for field in self.structs[struct][0]:
            name = field.name.rstrip("_")
            kind = ("function" if field.call else "``%s%s%s%s``" % ("const " if field.const else "", field.type, " " + "*"*field.pointer if
                    field.pointer else "", "[%s]" % field.dim if field.dim else ""))
            unit = UNIT.match(field.doc)
            unit = unit.group(0).strip() if unit and re.search("[a-zA-Z]", unit.group(0)) else ""
            doc = re.sub(r"^[ ,;.:]+", "", field.doc[len(unit):])
            if field.type in self.enums and not doc:
                doc = self.enums[field.type][1].split(". ")[0]
            cells = [self.anchor(struct + "." + name, name), kind, escape(unit) or r"\ ", inline(capital(doc)) or r"\ "]
            if rows and field.doc == rows[-1][4] and (doc or kind in rows[-1][1]):      # fields that share a comment
                rows[-1][0] += ", " + cells[0]
                rows[-1][1] += "" if kind in rows[-1][1] else ", " + kind
            else:
                rows.append(cells + [field.doc])
        return table([row[:4] for row in rows], "22 22 8 48", ["Field", "Type", "Unit", "Meaning"])


def write(folder, text):
    """Writes the pages into folder/reference; returns names and their places."""
    reference = Reference(text)
    os.makedirs(os.path.join(folder, "reference"), exist_ok=True)

    def page(name, title, lines):
        with open(os.path.join(folder, "reference", name + ".rst"), "w") as file:
            file.write("\n".join([".. role:: raw-html(raw)", "   :format: html", "", title, "="*len(title), ""] + lines) + "\n")
    page("manual", "The manual", prose("/* " + reference.manual.strip() + " */"))
    index = ["The public functions of dem.h, each with the first sentence of its comment. A name leads to its entry; structs, enums and "
             "types are on the same pages. :doc:`The manual <manual>` explains the concepts.", ""]
    for tag, lines in reference.parts:
        title = reference.titles[tag]
        page(tag, title[0].upper() + title[1:], lines)
        rows = [["``%s``" % name, inline(doc)] for name, doc in reference.first.items() if reference.names[name].startswith("reference/%s.html" % tag)]
        index += [title[0].upper() + title[1:], "-"*len(title), "", ":doc:`All entries of this part <%s>`" % tag, ""] + table(rows, "40 60") if rows else []
    page("index", "Reference", index)
    return reference.names
