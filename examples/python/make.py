"""python3 make.py [dem.h]: prints dem.py, which gives dem.h to Python, made of base.py and of the declarations of dem.h.

Structs, enums, constants, functions and their comments are those of the public half of dem.h. The rules of names are
in the docstring of dem.py. A declaration that no rule covers is an error."""
import keyword
import os
import re
import sys
import textwrap

HERE = os.path.dirname(os.path.abspath(__file__))
NUMBERS = {"int": "ctypes.c_int", "int32_t": "ctypes.c_int32", "uint32_t": "ctypes.c_uint32", "int64_t": "ctypes.c_int64",
           "uint64_t": "ctypes.c_uint64", "size_t": "ctypes.c_size_t", "double": "ctypes.c_double", "dem_real": "Real"}
BUILTIN = {"ARGUMENT": "ValueError", "MEMORY": "MemoryError", "FILE": "OSError", "FORMAT": "ValueError"}
HANDLES = {"dem_world": "World", "dem_replay": "Replay", "dem_slabs": "Slabs"}


def fail(text):
    sys.exit("make.py: " + text)


def camel(name):
    return "".join(word.capitalize() for word in re.sub(r"^dem_", "", name).split("_"))


ITEM, AFTER = "\1", "\2"         # in a comment: an item of a list or a row of a table begins; the text after a list


def clean(comment, lists=False):
    """The text of a comment. lists: items of lists and rows of tables begin with ITEM."""
    if lists:
        lines, within = comment.split("\n"), False
        for i, line in enumerate(lines[1:], 1):
            row = re.match(r" {7}(\S.*?) {2,}(\S.*)$", line)
            if re.match(" {3}- ", line) or row:
                lines[i], within = ITEM + (row.group(1) + (" " if row.group(1)[-1] in ",;:" else ": ") + row.group(2) if row
                                           else line.strip()), True
            elif within and re.match(r" {3}\S", line):
                lines[i], within = AFTER + line.strip(), False
        comment = "\n".join(lines)
    text = re.sub(r"\s+", " ", comment.replace("/*", " ").replace("*/", " ")).strip()
    text = re.sub(r" Tests: [^()]*(\([^()]*\)[^()]*)*$", "", text)
    return "" if text.startswith(("----", "-- ")) or text.startswith("--------") or ">>" in text[:8] else text


# ---- the declarations of dem.h ----

class Var:
    """A field or an argument: type, name, pointer, const, dim (of an array), comment; call: arguments of a function."""

    def __init__(self, text, doc=""):
        text = re.sub(r"\s+", " ", text).strip()
        self.call, self.dim = None, None
        found = re.match(r"(.*)\(\*(\w+)\)\((.*)\)$", text)
        if found:
            self.doc, self.call = doc, Function(found.group(1).strip(), found.group(2), found.group(3), doc)
            self.type, self.name, self.pointer, self.const = "function", found.group(2), 0, False
            return
        found = re.match(r"(const )?(?:struct )?(\w+) ?(\**) ?(\w+)(?:\[(\w+)\])?$", text) or fail("cannot read: " + text)
        self.const, self.type, self.pointer, self.name, self.dim = (
            bool(found.group(1)), found.group(2), len(found.group(3)), found.group(4), found.group(5))
        self.doc = re.sub("^%s: " % self.name, "", doc)
        self.name += "_" if keyword.iskeyword(self.name) else ""


class Function:
    def __init__(self, result, name, arguments, doc, inline=False):
        self.result, self.name, self.doc, self.inline = result, name, doc, inline
        self.arguments = [] if arguments.strip() in ("", "void") else [Var(a) for a in split(arguments)]
        found = re.match(r"(?:const )?(\w+) ?(\*?)$", result)
        self.type, self.star = found.group(1), bool(found.group(2))


def split(text, at=","):
    """Parts of text between commas outside of brackets."""
    parts, depth, part = [], 0, ""
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if c == at and not depth:
            parts.append(part)
            part = ""
        else:
            part += c
    return [p for p in parts + [part] if p.strip()]


def fields_of(body):
    """The fields of a struct with their comments: behind a field, or before it and those that follow."""
    fields, pending, last = [], "", []
    for token in re.finditer(r"/\*.*?\*/|[^;/]+;", body, re.S):
        text = token.group(0)
        if text.startswith("/*"):
            doc = clean(text)
            if last and "\n" not in body[last[0]:token.start()] and last[2] is not None:
                for field in last[1]:                       # behind a field, perhaps after a comment in front of it
                    field.doc = doc + (". " + field.doc if field.doc else "")
                last[2] = None
            else:
                pending, last = doc, []
            continue
        text = text.strip()[:-1]
        if "(*" in text:
            new = [Var(text, pending)]
        else:
            names = split(text)
            base = re.match(r"\s*((?:const )?(?:struct )?\w+)", names[0]).group(1)
            new = [Var(names[0], pending)] + [Var(base + " " + name.strip(), pending) for name in names[1:]]
        fields += new
        last, pending = [token.end(), new, bool(pending)], "" if pending else pending
    return fields


UNIT = r"(?:(?:m|s|kg|N|Pa|J|Hz|rad|W)\d*|[/ ()^\d])+"


def parted(doc, names):
    """A comment that several fields share as one for each, if it has as many parts as there are fields; None otherwise."""
    found = re.match(r"((?:%s)(?:(?:, | and )%s){%d})(?=$|[.:,])(.*)$" % (UNIT, UNIT, len(names) - 1), doc, re.S)
    if found:                                               # m, m/s, rad/s: of ...
        return [unit + found.group(2) for unit in re.split(", | and ", found.group(1))]
    parts, head, tail = [part.strip() for part in split(doc, ";")], "", ""
    if len(parts) != len(names) or any(". " in part for part in parts[:-1]):
        return None
    own = all(re.match(r"%s\b" % name, part) for name, part in zip(names, parts))
    if not own and any(re.match(r"(%s) (is|0|null)|\W*\d|otherwise|negative|compare|then\b|max|null|the pointers|both must|random mixtures" % "|".join(names), part)
                       or " 0 means" in part for part in parts):
        return None
    first = re.match(r"([^;:\[]{1,90}): (.+)", parts[0])
    last = re.match(r"([^:]*)(: .*)", parts[-1])
    if own:
        return [re.sub("^%s(?::| is|(?= null means)) " % name, "", part) for name, part in zip(names, parts)]
    if first and " and " not in first.group(1):             # lost: by ...; by ...
        head, parts[0] = first.group(1) + ": ", first.group(2)
    elif last and re.fullmatch(UNIT, parts[0]) and last.group(1) != names[-1]:      # m; unit, from a to b: where ...
        tail, parts[-1] = last.group(2), last.group(1)
    parts = [re.sub("^(and|%s:) " % name, "", part) for name, part in zip(names, parts)]
    for i, part in enumerate(parts[1:], 1):                 # J, lost on it by sliding; by the normal law
        found = re.match(r"(by|to|of) ", part)
        at = parts[0].find(" %s " % found.group(1)) if found and not parts[0].startswith(found.group(1) + " ") else -1
        if at > 0:
            parts[i] = parts[0][:at + 1] + part
    return [head + part + tail for part in parts]


def share(fields):
    """Gives fields that share a comment their parts of it."""
    begin = 0
    while begin < len(fields):
        end = begin + 1
        while end < len(fields) and fields[end].doc and fields[end].doc == fields[begin].doc:
            end += 1
        parts = parted(fields[begin].doc, [f.name for f in fields[begin:end]]) if end - begin > 1 else None
        for f, part in zip(fields[begin:end], parts or ()):
            f.doc = part
        begin = end
    return fields


class Header:
    def __init__(self, text):
        self.text = text
        public = text[text.index("\n#ifndef DEM_H\n"):text.index("\n#endif /* DEM_H */")]
        extra = re.search(r"#define DEM_LAW_COEFFICIENTS\(X\) \\\n((?: *X\(.*\\\n)*)", public).group(1)
        properties = re.findall(r"X\((\w+), (\w+),", extra)
        public = public.replace("DEM_LAW_COEFFICIENTS(DEM_PROPERTY_FIELD)", " ".join("dem_real %s;" % p for p, _ in properties))
        public = public.replace("DEM_LAW_COEFFICIENTS(DEM_COEFFICIENT_FIELD)", " ".join("dem_real %s;" % c for _, c in properties))
        public = public.replace("DEM_LAW_COEFFICIENTS(DEMI_ROW_FIELD)", " ".join("const dem_real *%s;" % c for _, c in properties))
        self.enums, self.structs, self.calls, self.functions = {}, {}, {}, []
        self.constants = [(n, v, "") for n, v in re.findall(r"#define (DEM_VERSION_\w+) (\d+)\n", public)]
        self.zero = set(re.findall(r"static const (dem_\w+) DEM_\w+_ZERO", public))
        comment, at = "", 0
        while at < len(public):
            rest = public[at:]
            found = re.match(r"\s+", rest)
            if found:
                at += found.end()
                continue
            if rest.startswith("/*"):
                end = rest.index("*/") + 2
                comment = clean(rest[:end], lists=True)
                at += end
                continue
            if rest.startswith("#"):
                at += re.match(r"#(?:.*\\\n)*.*", rest).end()
                comment = ""
                continue
            if rest.startswith(('extern "C" {', "}")):
                at += len('extern "C" {') if rest[0] == "e" else 1
                continue
            text, length = self.declaration(rest)
            at += length
            self.declare(text, comment)

    def reads(self, law):
        """The fields of the force that a law, and the functions to which it passes the force, read and do not set."""
        read, written, done, queue = set(), set(), set(), [law]
        while queue:
            name = queue.pop()
            done.add(name)
            body = re.search(r"DEM_INLINE [\w ]+?\b%s\(.*?\n\}\n" % name, self.text, re.S)
            body = re.sub(r"/\*.*?\*/", "", body.group(0) if body else fail("no body of " + name), flags=re.S)
            written |= set(re.findall(r"\bf->(\w+)(?:\.\w+)? [-+]?= ", body))
            read |= set(re.findall(r"\bf->(\w+)\b(?!(?:\.\w+)? [-+]?= )", body))
            queue += [other for other in re.findall(r"\b(demi?_law_\w+)\([^;]*?\bf\b(?!-)", body) if other not in done]
        return [name for name in ("slope", "slope_step", "kt", "kt_step", "ct", "load") if name in read - written]

    @staticmethod
    def declaration(text):
        """The declaration at the beginning of text, with its comments, and its length."""
        depth, i = 0, 0
        while i < len(text):
            if text.startswith("/*", i):
                i = text.index("*/", i) + 2
                continue
            c = text[i]
            depth += (c in "({") - (c in ")}")
            i += 1
            if not depth and (c == ";" or c == "}" and re.match(r"(DEM_INLINE|static inline)", text)):
                return text[:i], i
        fail("a declaration does not end: " + text[:80])

    def declare(self, text, doc):
        found = re.match(r"typedef enum (\w+) \{(.*)\} \w+;$", text, re.S) or re.match(r"(enum) \{(.*)\};$", text, re.S)
        if found:
            values, number = [], 0
            pending = ""
            for token in re.finditer(r"/\*.*?\*/|[^,/]+", found.group(2), re.S):
                item = token.group(0).strip()
                if item.startswith("/*"):
                    before = found.group(2)[:token.start()].rstrip(" ")
                    if values and not before.endswith("\n"):
                        values[-1][2] = clean(item)
                    else:
                        pending = clean(item)
                elif item:
                    name, _, value = (part.strip() for part in item.partition("="))
                    number = int(value, 0) if value else number
                    values.append([name, number, pending])
                    number, pending = number + 1, ""
            if found.group(1) == "enum":
                self.constants += [(name, value, note) for name, value, note in values]
            else:
                self.enums[found.group(1)] = (values, doc)
            return
        found = re.match(r"(?:typedef )?struct (\w+) \{(.*)\}[ \w]*;$", text, re.S)
        if found:
            self.structs[found.group(1)] = (share(fields_of(found.group(2))), doc)
            return
        found = re.match(r"typedef ([\w ]+?\*?) ?\(\*(\w+)\)\((.*)\);$", text, re.S)
        if found:
            self.calls[found.group(2)] = Function(found.group(1), found.group(2), found.group(3), doc)
            return
        found = re.match(r"(DEM_API|DEM_INLINE) ([\w ]+?[ *]+)(dem_\w+)\((.*?)\)\s*[;{]", text, re.S)
        if found:
            self.functions.append(Function(found.group(2).strip(), found.group(3), found.group(4), doc, found.group(1) == "DEM_INLINE"))
        elif not re.match(r"(typedef struct dem_\w+ dem_\w+;|typedef DEM_REAL|struct dem_\w+;|static const |static inline dem_world \*dem_world_create|"
                          r"DEM_INLINE \w+ demi_|extern )", text):
            fail("no rule for: " + text[:100])


# ---- Python text ----

def doc_lines(indent, text, more=()):
    """A docstring: the comment, and a paragraph for each further line."""
    pad, lines = " "*indent, []
    for part in re.split("(?=[%s%s])" % (ITEM, AFTER), text):
        lines += textwrap.wrap(part.strip(ITEM + AFTER + " "), 118 - indent, subsequent_indent="    "*part.startswith(ITEM),
                               break_long_words=False, break_on_hyphens=False) or [""]
    for line in more:
        if not lines[-1].startswith("    ") and line is more[0]:
            lines.append("")
        lines += textwrap.wrap(line, 118 - indent, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    text = "\n".join((pad + line).rstrip() for line in lines).strip().replace("\\", "\\\\").replace('"""', "'''")
    return '%s"""%s%s"""\n' % (pad, text, "\n" + pad if len(lines) > 1 else "")


def folded(line, width, indent):
    """A line of code as lines of this width; texts in quotes are not divided."""
    line = re.sub(r"'[^']*'", lambda found: found.group(0).replace(" ", "\0"), line)
    return [piece.replace("\0", " ") for piece in textwrap.wrap(line, width, subsequent_indent=indent, break_long_words=False,
                                                                 break_on_hyphens=False)]


# comments of C in the words of Python: pattern, replacement; the first ones first
SAY = [(r"null (if desc\.body_reals names none)", r"empty \1"), ("(the next step); null: none", r"\1; empty: none"),
       ("the pointers are null if reals_a is", "they are empty if reals_a is"),
       (r" ?\(>>\w+( has the formulas)?\)|, >>\w+(?=\))", ""), (r" Begin with DEM_\w+_DESC(: they do not)?\.", ""),
       (r"\b(CALL|CSV|FIELD_CSV|WALLS):", lambda found: 'kind "%s":' % found.group(1).lower()),
       (r"dem_world_error_get\(world\) returns", "world.error has"), (r"`box` and errors as above", "`box` and errors as for dem_repose_heap_get"),
       (r"\bDEM_SELECTION, all zero,", "Selection()"), (r"\bDEM_MOTION\b", "Motion()"),
       (r" Free (it |the mesh |)with dem_\w+_free\.", ""),
       (r"(Writes|writes) (the .*?|for every effect .*?|positions \(count x 3\) and radii \(count\)),? (at most `capacity` of them, )?and returns their number"
        r"( \(0: the wall has no facets\))?\.", lambda m: ("Returns " if m.group(1) == "Writes" else "returns ") + m.group(2).rstrip(",") + "."),
       (r"Writes (the ids .*?), at most `capacity` of them\. Returns how many are selected, -1 on error\.", r"Returns \1."),
       (r", and returns how many it found \(0 if the call fails\)\. Writes at most `capacity` findings, the most severe first; `findings` or null\.",
        ", and returns them, the most severe first."),
       (r"Writes for every effect", "Returns for every effect"), (r": writes positions \(count x 3\) and radii \(count\), in m,", ": returns positions (count x 3) and "
        "radii, m,"), (r"Writes pointers to the sums of a field to `data`\.", "Returns views of the sums of a field."),
       (r" `(out|findings)` or null(, to count them)?\.", ""), (r" (user|work|fit|health|fn and user): or null\.", ""),
       (r" walls: receives `count` ids; or null\.", ""), (r" user: not used, or null, as in the next three\.", ""),
       (r"and, if `health` is not null, counts", "and counts"), (r"\(capacity x ", "(count x "),
       (r"^Writes (the (?:state|contact properties|sums|loads|pose|desc|\w+(?: \w+)*?) of [^.]*?),? to `?\w+`?\.", r"Returns \1."),
       (r"Returns the number of classes that are not empty; 0 on error\.", "Returns the radii and the amounts of the classes that are not empty."), (r"name: for error messages; or null\.", "name: for error messages."),
       (r"(reads? \w+( \w+)*? from memory), `size` bytes at `data`", r"\1 (`data`)"), (r", `size` bytes at `data`", " (`data`)"),
       (r"\bprogress: or null\.", "progress: a function, or None."), (r" desc: or null, for DEM_REPLAY_DESC\.", ""),
       (r"; zeros (if there is none|for a null world)", ""), (r" For a null world the message says that it is null\.", ""),
       (r" \(0 if the call fails\)", ""), (r"[,;] (-1|0) on error", ""), (r", -1 on error", ""),
       (r"Returns -1 on error, also (while|if)", r"It is an error \1"), (r"Returns -1 (also )?(if|while)", r"It is an error \2"),
       (r", and returns -1 where a step would fail", ""), (r"Returns their number\.", "Returns their number."),
       (r"\bNull\b", "None"), (r"the null id\b", "the id 0"), (r"\bor null\b", "or None"), (r"\bnull\b", "None"), (r"\b([Ii])d 0 means", "None means"),
       (r"\b(c|f|force|s)->", r"\1."), (r"(?<![\w)] )\*c\b", "c"), (r"\breturn(s?) DEM_ERROR_", r"raise\1 DEM_ERROR_"), (r"\bstruct (dem_\w+)", r"\1")]
NUMBERS_DOC = ("The numbers (World(body_reals=...)) of %s. Values must be finite. Laws use them from the next step on. It is an error if the world has no "
               "names of such numbers.")
DOCS = {name: NUMBERS_DOC % what for name, what in (
    ("dem_body_reals_get", "a body, as a copy"), ("dem_body_reals_set", "a body: sets them"), ("dem_wall_reals_get", "a wall, as a copy"),
    ("dem_wall_reals_set", "a wall: sets them"), ("dem_bodies_reals_set", "all bodies, count x real_count: sets them, in the order of "
                                                                        "world.bodies"))}
DOCS["dem_world_error_get"] = ('Returns the error message of the last call on this world that failed; "" if none failed. Exceptions have it already.')


class Writer:
    def __init__(self, header):
        self.h, self.out = header, []
        self.spoken = {}        # names of C in Python
        self.ids = [n for n, (fields, _) in header.structs.items()
                    if [f.name for f in fields] in (["id"], ["slot", "generation"])]
        self.typed = {}         # annotated signatures, by owner
        self.nulls = {}         # arguments that may be None, by function
        self.free = {f.name[:-5]: f.name for f in header.functions if f.name.endswith("_free")}

    def say(self, text):
        """A comment of dem.h in the words of Python."""
        h = self.h
        if not self.spoken:
            self.spoken.update((f.name, self.called(f) if self.owner(f) or f.name == "dem_world_create_checked" else "dem." + self.called(f))
                               for f in h.functions)
            self.spoken.update(dem_world_create="World", dem_world_destroy="World.close", dem_replay_close="Replay.close")
            self.spoken.update((name, camel(name)) for name in list(h.structs) + list(h.enums) + list(h.calls) + list(HANDLES))
            for name, (values, _) in h.enums.items():
                words = [value for value, _, _ in values]
                prefix = os.path.commonprefix(words)
                prefix = prefix[:prefix.rindex("_") + 1]
                for word in words:
                    self.spoken[word] = '"%s"' % word[len(prefix):].lower() if name != "dem_result" else (
                        camel(word[len("DEM_ERROR_"):].lower()) + "Error" if "ERROR" in word else word)
            self.spoken.update((name, "dem." + name[4:]) for name, _, _ in h.constants)
            self.spoken.update(DEM_RAIL_="dem.RAIL_")
        for pattern, words in SAY:
            text = re.sub(pattern, words, text)
        def field(found):
            name, value = found.group(1), found.group(2)
            if name not in [f.name for f in h.structs["dem_world_desc"][0]]:
                return found.group(0)[len("desc."):]
            return "World(%s=%s)" % (name, value or "...")
        text = re.sub(r"\bdesc\.(\w+)(?: (?:is|=) (\d+))?(?!\w|\()", field, text)
        return re.sub(r"\b(dem_\w+|DEM_\w+)(\(\))?", lambda m: self.spoken.get(m.group(1), m.group(0)), text).replace("World.World.", "World.")

    def write(self, text=""):
        self.out.append(text.rstrip("\n"))

    # -- types --
    def value(self, var, kind=True):
        """A type as Python text; kind: as the kind of a field of a Struct, otherwise as a type of ctypes."""
        t = var.type
        if var.call:
            return "None"
        if var.dim and t == "char":
            return "Text(%s)" % self.number(var.dim)
        if var.pointer == 2 or (var.pointer and t in HANDLES) or (var.pointer and t in ("void", "FILE")):
            base = "ctypes.c_void_p"
        elif var.pointer and t == "char":
            base = "str" if kind else "ctypes.c_char_p"
        elif var.pointer:
            base = "ctypes.POINTER(%s)" % self.plain(t)
        elif t in self.h.enums:
            base = camel(t) if kind and not var.dim else "ctypes.c_int"
        elif t in self.h.calls:
            base = camel(t) if kind else camel(t) + ".c"
        else:
            base = self.plain(t)
        if var.dim and t in self.h.enums and kind:
            return "Choices(%s, %s)" % (camel(t), self.number(var.dim))
        return "%s*%s" % (base, self.number(var.dim)) if var.dim and kind else base

    def plain(self, t):
        if t in NUMBERS:
            return NUMBERS[t]
        if t in self.h.structs:
            return camel(t)
        if t in self.h.enums:
            return "ctypes.c_int"
        if t in self.h.calls:
            return camel(t) + ".c"
        fail("no rule for the type " + t)

    def number(self, dim):
        return dim if dim.isdigit() else re.sub("^DEM_", "", dim)

    # -- shapes of arrays, from comments --
    def shape(self, struct, field, fields):
        doc = field.doc
        group = [f for f in fields if f.doc == doc and f.pointer]
        named = re.search(r"\b%s: (count|cells)\b(?: x (\w+))?" % field.name, doc)
        parts = doc.split(";")
        if not named and len(group) > 1 and len(parts) == len(group):
            doc = parts[group.index(field)]
        found = named or re.search(r"\b(count|cells)\b(?: x (\w+))?", doc)
        if not found:
            found = {f.name: m for f, m in zip([f for f in fields if f.pointer],
                                               re.finditer(r"\b(\w+_count) x (\w+)", self.h.structs[struct][1]))}.get(field.name)
        if not found:
            return [repr(LENGTHS[struct])] if struct in LENGTHS and field.type in NUMBERS else None
        return [repr(found.group(1))] + ([found.group(2) if found.group(2).isdigit() else repr(found.group(2))] if found.group(2) else [])

    def counts(self, name, fields):
        """Lengths that follow from arrays: {length: ((array, width), ...)}; all arrays of a length must have it."""
        found = {}
        for i, field in enumerate(fields):
            if field.type != "int" or not re.search(r"(^|_)count$", field.name) or name in (
                    "dem_bodies", "dem_trials", "dem_contact_rows"):
                continue
            word = field.name[:-6]
            arrays = [f for f in fields if (f.pointer and f.type not in ("char", "void")) or (f.dim and f.type not in ("char",))]
            array = next((f for f in arrays if word and f.name.startswith(word[:4])), None)
            if not array and word in ("", "class"):
                array = next((f for f in fields[i:] if f in arrays), None)
            if array:
                def width(f):
                    shape = self.shape(name, f, fields) if f.pointer and not f.dim else None
                    return int(shape[1]) if shape and len(shape) > 1 and shape[1].isdigit() else 1
                also = [f for f in arrays if f is not array and (
                    f.dim and f.dim == array.dim or f.pointer and not f.dim and (
                        (self.shape(name, f, fields) or [None])[0] == repr(field.name) or "one each" in f.doc))]
                found[field.name] = tuple((f.name, width(f)) for f in [array] + also)
        return found

    # -- parts of the file --
    def enum(self, name):
        values, doc = self.h.enums[name]
        names = [v[0] for v in values]
        prefix = os.path.commonprefix(names)
        prefix = prefix[:prefix.rindex("_") + 1]
        self.constants.update((value, repr(value[len(prefix):].lower())) for value in names if name != "dem_result")
        if name == "dem_result":
            prefix = "DEM_"
        self.write("\n\nclass %s(enum.IntEnum):" % camel(name))
        self.write(doc_lines(4, self.say(doc)))
        for value, number, note in values:
            short = value[len(prefix):]
            short = "_" + short if short[0].isdigit() else short
            if note:
                for line in textwrap.wrap(self.say(note), 112):
                    self.write("    # " + line)
            self.write("    %s = %d" % (short, number))

    def wrap(self, f):
        """A function type: how a Python function becomes a C function, and the type."""
        name = camel(f.name)
        struct_result = f.type in self.h.structs and not f.star
        given, poison, pointers, kept, consts = [], None, [], [], []
        for a in f.arguments:
            if a.name == "user":
                continue
            if a.pointer and a.type == "dem_world":
                given.append("context.world(%s)" % a.name)
            elif a.pointer and a.type in self.h.structs:
                kept.append((a.name, "%s(%s)" % (a.name + "_of" if a.const else camel(a.type) + ".from_address", a.name)))
                consts += [a] if a.const else []
                given.append("_" + a.name)
                if not a.const and (poison is None or poison[1]):
                    poison = (a.name, False)
            elif a.pointer and a.type in NUMBERS and "count" in [x.name for x in f.arguments]:
                given.append("ctypes.cast(%s, ctypes.POINTER(%s*count))[0]" % (a.name, NUMBERS[a.type]))
            elif a.pointer and a.type in NUMBERS:
                kept.append((a.name, "%s_type.from_address(%s) if %s else %s_type()" % ((a.name,)*4)))
                given.append("_" + a.name)
                pointers.append(a)
                if not a.const and poison is None and f.name not in ("dem_contact_fn",):
                    poison = (a.name, True)
            else:
                given.append(a.name)
        if struct_result:           # ctypes has no functions that return a struct: see World.__init__
            self.write("\n\n%s = Function(None, ctypes.c_void_p)" % name)
            self.write("%s.__doc__ = %r" % (name, self.say(f.doc)))
            return
        names = ", ".join(a.name for a in f.arguments)
        self.write("\n\ndef _wrap_%s(function, context, struct):" % f.name)
        for a in pointers:
            size = {"memory": "context.memory", "rates": "2" if "rate_fn" in f.name else "context.reals", "reals": "context.reals",
                    "values": "len((struct.columns or '').split())"}.get(a.name) or fail(
                        "no rule for the length of %s of %s" % (a.name, f.name))
            self.write("    %s_type = " % a.name + ("_history(context.memory, context.vectors)" if a.name == "memory" else
                "_row_read(%s, %s)" % (NUMBERS[a.type], size) if a.const else "%s*%s" % (NUMBERS[a.type], "(%s)" % size if "(" in size else size)))
        for a in consts:
            self.write("    %s_of = _read(%s).from_address" % (a.name, camel(a.type)))
        show = [a.name for a in consts if "_per_body" in [
            LENGTHS.get(t) for t in [a.type] + [field.type for field in self.h.structs[a.type][0]]]]
        if show:
            self.write("    shown = context.reals and {'_per_body': context.reals}")
        result = "None" if f.type == "void" and not f.star else "ctypes.c_void_p" if f.star else self.plain(f.type)
        self.write("\n    def call(%s):" % names)
        self.write("        try:")
        for name_, made in kept:
            self.write("            _%s = %s" % (name_, made))
            if name_ in show:
                self.write("            if shown:")
                self.write("                _%s.__dict__.update(shown)" % name_)
        call = "function(%s)" % ", ".join(given)
        about = re.sub("^dem_(replay_desc_|output_desc_)?|_fn$", "", f.name)
        if result == "None":
            if f.name in ("dem_contact_fn", "dem_event_fn", "dem_allocator_free_fn"):
                self.write("            %s" % call)
            else:
                self.write("            result = %s" % call)
                self.write("            if result is not None:")
                self.write("                raise _returned(result, %r)" % about)
        elif result == "ctypes.c_void_p":
            self.write("            return %s" % call)
        elif result in ("ctypes.c_double", "Real"):
            self.write("            result = _real_from(%s, %r)" % (call, about))
        else:
            self.write("            result = int(bool(%s) or context.raised is not None%s)" % (
                call, " or context.stop" if f.name == "dem_progress_fn" else ""))
        for name_, _ in kept:
            self.write("            if _refs(_%s) > _ONE and _held(_%s):" % (name_, name_))
            self.write("                raise _kept(%r, %r)" % (name_, about))
        if result not in ("None", "ctypes.c_void_p"):
            self.write("            return result")
        self.write("        except BaseException as error:")
        self.write("            context.fail(" + ("_beyond(error, %r, %s) if type(error) is IndexError else error" % (about, ", ".join(
            "%s=%s_type" % (a.name, a.name) for a in pointers)) if pointers else "error") + (
            ", %r)" % about if f.name in SPOILING else ")"))
        if poison:
            self.write("            Real.from_address(%s).value = _NAN" % poison[0])
        if result in ("ctypes.c_double", "Real"):
            self.write("            return _NAN")
        elif result not in ("None", "ctypes.c_void_p"):
            self.write("            return 1")
        kinds = ["ctypes.c_void_p" if a.name in [name_ for name_, _ in kept] else self.value(a, False) for a in f.arguments]
        self.write("    return ctypes.cast(ctypes.CFUNCTYPE(%s)(call), %s.c)" % (", ".join([result] + kinds), name))
        self.write("\n\n%s = Function(%s)" % (name, ", ".join(
            ["_wrap_" + f.name, result] + [self.value(a, False) for a in f.arguments])))
        self.write("%s.__doc__ = %r" % (name, self.say(f.doc)))

    def struct(self, name):
        fields, doc = self.h.structs[name]
        rows = []
        for f in fields:
            kind = self.value(f)
            if f.call:
                f.call.name = name + "_" + f.name
                self.wrap(f.call)
                kind = camel(f.call.name)
            elif f.pointer and f.dim and f.type in self.h.structs:
                kind = "ctypes.POINTER(%s)*%s" % (self.plain(f.type), self.number(f.dim))
            elif f.pointer and kind.startswith("ctypes.POINTER"):
                shape = self.shape(name, f, fields)
                counted = f.name in [a for arrays in self.counts(name, fields).values() for a, _ in arrays]
                if not shape and not counted and f.type not in self.h.structs:
                    fail("no rule for the length of %s of %s" % (f.name, name))
                one = f.type in self.h.structs and not shape and not counted
                more = ["const=True"]*f.const + ["one=True"]*one + ["times=" + self.number(f.dim or "0")]*bool(f.dim)
                kind = "View(%s)" % ", ".join([self.plain(f.type)] + (shape or []) + more)
            if (name, f.name) in KNOWN:
                kind = "_Known(%s)" % kind
            rows.append((f.name, kind, self.say(f.doc)))
        self.write("\n\n@_struct\nclass %s(%s):" % (camel(name), BASES.get(name) or ("Id" if name in self.ids else "Struct")))
        self.write(doc_lines(4, self.say(doc) or "The id of a %s." % name[4:]))
        self.write("    c_name = %r" % name)
        required = tuple(f.name for f in fields if re.match(r"(\S+, )?required\b(?! if)", f.doc)
                         and "; may be 0" not in f.doc and f.name not in self.counts(name, fields))
        for table, value in (("uses", self.uses(name, fields)), ("defaults", DEFAULTS.get(name)),
                             ("needs", NEEDS.get(name)), ("positive", POSITIVE.get(name)), ("required", required)):
            for line in folded("%s = %r" % (table, value), 110, "        ") if value else ():
                self.write("    " + line)
        counts = self.counts(name, fields)
        if counts:
            self.write("    counts = %r" % counts)
        self.write("    rows = [")
        last = None
        for row, kind, note in rows:
            head = "        (%r, %s, " % (row, kind)
            if note == last and note:
                self.write(head + 'None),')
                continue
            last = note
            lines = textwrap.wrap(note, 100, drop_whitespace=False, break_long_words=False, break_on_hyphens=False)
            if not lines or len(head) + len(repr(note)) < 118:
                self.write(head + repr(note) + "),")
            else:
                self.write(head.rstrip())
                self.write("\n".join("         " + repr(line) for line in lines) + "),")
        self.write("    ]")
        for f in self.h.functions:
            if self.owner(f) == name:
                self.method(f, name)

    def uses(self, name, fields):
        """The conditions of USES as Python has them: {field: ((other, words), ...)}."""
        found, types = {}, {f.name: f.type for f in fields}
        for one, text in USES.get(name, {}).items():
            for condition in text.split():
                other, _, words = condition.strip("!").partition("=")
                known = [value.lower() for value, _, _ in self.h.enums.get(types.get(other), ((), ""))[0]]
                if one not in types or other not in types or words and not all(
                        any(value.endswith("_" + word) for value in known) for word in words.split("|")):
                    fail("no such field or word in USES: %s of %s: %s" % (one, name, condition))
                found.setdefault(one, []).append((other, tuple(words.split("|")) if words else condition[0] != "!"))
        return {one: tuple(conditions) for one, conditions in found.items()}

    # -- functions --
    def owner(self, f):
        """The class that a function becomes a method of: an id, a handle, or None."""
        if not f.arguments or not f.arguments[0].pointer or f.arguments[0].type not in HANDLES:
            return None
        if len(f.arguments) > 1:
            kind = f.arguments[1].type
            if kind in self.ids and not f.arguments[1].pointer and f.name.startswith(kind + "_"):
                return kind
        return f.arguments[0].type

    def short(self, f, owner):
        """The name of a method."""
        name = f.name[len(owner) + 1:] if f.name.startswith(owner + "_") else f.name[4:]
        for end in ("_add", "_get", "_open", "_create"):
            if name.endswith(end):
                name = name[:-len(end)]
        if name == "get":                   # named after the struct that it returns
            name = f.arguments[-1].type.split("_")[-1]
        if f.name == "dem_bodies_add":
            name = "bodies_add"             # world.bodies are those that are there
        if f.name == "dem_bodies_get":
            name = "bodies_memory"          # world.bodies has them in the order of adding
        return name

    def called(self, f):
        """The name of a function in Python."""
        owner = self.owner(f)
        if f.name == "dem_world_create_checked":
            return "World"
        return "%s.%s" % (camel(owner), self.short(f, owner)) if owner else re.sub("_get$", "", f.name[4:])

    def signature(self, f):
        owner, names = self.owner(f), []
        for i, a in enumerate(f.arguments):
            own = owner and (i == 0 or i == 1 and owner not in HANDLES)
            names.append("self" if own else a.name + "="*(a.name in self.nulls.get(f.name, ()) or a.name == "user"))
        return "(%r, %s, [%s], %r, %r)" % (("dempy_" if f.inline else "") + (f.name[4:] if f.inline else f.name), self.result(f),
                                           ", ".join(self.argument(a) for a in f.arguments), self.called(f), names)

    def result(self, f):
        if f.star:
            return "ctypes.c_char_p" if f.type == "char" else "ctypes.c_void_p"
        return "None" if f.type == "void" else self.plain(f.type)

    def argument(self, a):
        if a.dim:
            return "ctypes.POINTER(%s)" % self.plain(a.type)
        return self.value(a, False)

    def method(self, f, owner):
        """A method, a property, or a function of the module (owner None)."""
        h, args = self.h, list(f.arguments)
        name = self.short(f, owner) if owner else re.sub("_get$", "", f.name[4:])
        world = "self" if owner in HANDLES else "self.world"
        pass_on, pre, outs, params, docs, fields = [], [], [], [], [], None
        if owner:
            pass_on.append("%s._c" % world)
            args.pop(0)
            if owner not in HANDLES:
                pass_on.append("self")
                args.pop(0)
        counter = next((i for i, a in enumerate(args) if a.name == "count"), len(args))
        arrays = [a for i, a in enumerate(args) if a.pointer and not a.dim and a.type in (NUMBERS if i < counter else {**NUMBERS, **h.structs})
                  and (a.type in NUMBERS or a.const or a.type in self.ids)
                  or a.pointer and [x.name for x in args[i + 1:]] == ["capacity"]]
        inputs = [a for a in arrays if a.const]
        counted = any(a.name == "count" for a in args) and inputs
        capacity = any(a.name == "capacity" for a in args)
        optional = False
        where = self.called(f)
        where = where if "." in where else "dem." + where

        def at(a):
            return "%r" % ("%s: %s" % (where, a.name))
        if not owner and f.inline:              # laws, in laws
            params = [(a.name, None) for a in args]
            pass_on, args, arrays, inputs = [a.name for a in args], [], [], []
        for i, a in enumerate(args):
            kind = a.type
            following = args[i + 1] if i + 1 < len(args) else None
            if a.name == "user":
                pass_on.append("None")
            elif kind in h.calls:
                params.append((a.name, "None" if kind == "dem_progress_fn" or re.search(r"\b%s(?: and user)?: or null" % a.name, f.doc) else None))
                value = a.name
                if f.name == "dem_contacts_each":
                    params[-1] = (a.name, "None")
                    value = "_seen if %s is None else %s" % (a.name, a.name)
                if kind == "dem_progress_fn":
                    value = "_go_on if %s is None else %s" % (a.name, a.name)
                pre.append("%s = %s._callback(%s, %s, %s)" % (a.name, world, camel(kind), value, at(a)))
                takes = ", ".join(x.name for x in h.calls[kind].arguments if x.name != "user")
                docs.append("%s: %s(%s), see dem.%s" % (a.name, a.name, takes, camel(kind)))
                pass_on.append(a.name)
            elif a.name == "count" and counted:
                pass_on.append("count")
            elif a in inputs:
                width = 1
                if kind == "dem_real":
                    found = re.search(r"\b%ss?\b[^.;]*?\(?(?:count|of)?\b[^.;]*?count x (\d)" % re.escape(a.name.rstrip("s")), f.doc)
                    found = found or (len(inputs) == 1 and re.search(r"count x (\d)", f.doc))
                    width = int(found.group(1)) if found else 1
                first = a is inputs[0]
                null = not first and counted and re.search(r"\b%ss?\b[^.]*null" % a.name.rstrip("s"), f.doc)
                params.append((a.name, "None" if null else None))
                optional = optional or bool(null)
                item = camel(kind) if kind in h.structs else self.plain(kind)
                source = "_parts_of(%s, %s, %s)" % (a.name, world, at(a)) if kind == "dem_wall_part" else a.name
                if not counted:             # numbers of bodies and walls
                    rows = "%s.bodies.count" % world
                    pre.append("%s = _array_of(%s, %s, %s, %s)" % (
                        a.name, a.name, item, at(a), "1, %s._context.reals" % world if f.name != "dem_bodies_reals_set" else
                        "%s._context.reals, %s" % (world, rows)))
                    if f.name == "dem_bodies_reals_set":
                        pre.append("%s = %s.bodies._in_memory(%s, %s._context.reals)" % (a.name, world, a.name, world))
                elif first:
                    pre.append("%s = _array_of(%s, %s, %s, %d)" % (a.name, source, item, at(a), width))
                    pre.append("count = len(%s)%s" % (a.name, "" if width == 1 else "//%d" % width))
                else:
                    pre.append("%s = _array_of(%s, %s, %s, %d, count, %s)" % (a.name, source, item, at(a), width, bool(null)))
                pass_on.append(a.name)
            elif a.dim or (a in arrays and not a.const):
                item = camel(kind) if kind in h.structs else self.plain(kind)
                width = 1
                found = re.search(r"\b%s\b[^.;]*?x (\d)" % a.name, f.doc) if kind == "dem_real" else re.search(
                    r"capacity x (\d)", f.doc) if capacity else None
                width = int(found.group(1)) if found else 1
                size = (self.number(a.dim) if a.dim else "capacity" if capacity else "count" if any(x.name == "count" for x in args) else
                        "class_count" if any(x.name == "class_count" for x in args) else "%s._context.reals" % world)
                if capacity:
                    pre.append("capacity = %s" % ("64" if "finding" in kind else "%s._number(_lib.%s(%s, None, 0))" % (world, f.name, ", ".join(pass_on))))
                whole = item if width == 1 else "_row(%s, %d)" % (item, width)
                if size in ("count", "class_count") and not counted:
                    pre.append("%s = _row(%s, _size_of(%s, %r))()" % (a.name, whole, size, "%s: %s" % (where, size)))
                else:
                    pre.append("%s = _row(%s, max(%s, 1))()" % (a.name, whole, size))
                pass_on.append("ctypes.cast(%s, ctypes.POINTER(%s))" % (a.name, item))
                outs.append((a.name, size))
            elif a.name == "capacity":
                pass_on.append("capacity")
            elif a.pointer and kind in HANDLES:
                params.append((a.name, None))
                pass_on.append("_handle_of(%s, %s, %s)" % (a.name, HANDLES[kind], at(a)))
            elif a.pointer and kind == "FILE":
                params.append(("out", "None"))
                pass_on.append("FILE")
            elif a.pointer and kind in h.structs and not a.const and kind in self.free and f.name.endswith("_place"):
                params.append((a.name, None))
                pass_on.append("_struct_of(%s, %s, %s)" % (camel(kind), a.name, at(a)))
            elif a.pointer and kind in h.structs and not a.const:
                pre.append("%s = %s()" % (a.name, camel(kind)))
                pass_on.append(a.name)
                outs.append((a.name, None))
            elif a.pointer and kind in h.structs and all(x.pointer and x.type in h.structs and not x.const for x in args[i + 1:]) and (kind in h.zero or f.name.endswith("_set")):
                fields = (a, kind)
                pass_on.append(a.name)
            elif a.pointer and kind in h.structs:
                params.append((a.name, None))
                make = "_struct_of(%s, %s, %s)" % (camel(kind), a.name, at(a))
                pre.append("%s = %s" % (a.name, "%s._bound(%s)" % (world, make) if owner else make))
                pass_on.append(a.name)
            elif a.pointer and kind == "char":
                params.append((a.name, None))
                pass_on.append("_text_of(%s, %s)" % (a.name, at(a)))
            elif a.pointer and kind == "void":
                params.append((a.name, None))
                if a.name == "data":
                    pre.append("data = _data_of(data, %s)" % at(a))
                pass_on.append(a.name)
            elif a.name == "size" and i and args[i - 1].name == "data":
                pass_on.append("len(data)")
            elif kind in h.enums:
                params.append((a.name, "0" if owner and a is args[-1] else None))
                pass_on.append("_enum_of(%s, %s, %s)" % (a.name, camel(kind), at(a)))
            elif kind == "dem_region":
                params.append((a.name, None))
                pass_on.append("%s._bound(_struct_of(Region, %s, %s))" % (world, a.name, at(a)))
            else:
                last = all(x.pointer or x.type in h.calls or x.name == "user" for x in args[i + 1:])
                any_id = kind in self.ids and re.search(r"\bid (?:0 means|is 0)", f.doc)     # None: an id of 0
                if any_id:
                    self.nulls.setdefault(f.name, set()).add(a.name)
                last = last or any_id and all(x.pointer or x.type == kind for x in args[i + 1:]) and not any(x.const for x in args[i + 1:])
                default = "None" if (kind == "dem_box" or any_id) and last else "(1, 0, 0, 0)" if a is args[-1] and a.name == "orientation" else "0" if optional or (f.name, a.name) in ZEROS else "1" if f.name == "dem_world_step" else None
                params.append((a.name, default))
                if default == "None":
                    self.nulls.setdefault(f.name, set()).add(a.name)
                pass_on.append(a.name)
        # -- keyword arguments for the fields of a desc --
        star, given = [], ""
        if fields:
            a, kind = fields
            members = self.h.structs[kind][0]
            lengths = self.counts(kind, members)

            def hidden(m):
                return m.name in lengths or m.type == "void"
            base = f.name.endswith("_set") and any(g.name == f.name[:-4] + "_get" for g in h.functions)
            taken = {p for p, _ in params}
            sets = re.match(r"Sets ([\w, ]+)\.", f.doc)         # the fields that the function uses, if it names them
            sets = re.findall(r"\w+", sets.group(1).replace(" and ", ", ")) if sets else []
            if base and sets and set(sets) <= {m.name for m in members}:
                taken |= {m.name for m in members} - set(sets)
            star = [(m.name, "None" if base else self.default(m)) for m in members if m.name not in taken]
            if base:
                getter = next(g for g in h.functions if g.name == f.name[:-4] + "_get")
                inner = ("self." + self.short(getter, owner)) if owner not in HANDLES else "self.%s(%s)" % (
                    self.short(getter, owner), ", ".join(p for p, _ in params))
                pre.append("%s = _renamed(lambda: %s, %r, %r)" % (a.name, inner, self.called(getter), where))
                pre.append("%s._put({name: value for name, value in (%s,) if value is not None}, %r)" % (
                    a.name, ", ".join("(%r, %s)" % (m, m) for m, _ in star), where + ": "))
            else:
                pre.append("%s = %s._of_call(%r, dict(%s))" % (a.name, camel(kind), where, ", ".join("%s=%s" % (m, m) for m, _ in star)))
            key = ", (%r, self)" % f.name if owner not in HANDLES else ""
            if any(m.call or m.type in h.calls or m.type in ("dem_motion", "dem_region") or m.type in self.ids for m in members):
                pre.append("%s = %s._bound(%s%s)" % (a.name, world, a.name, key))
            for m in members:
                if m.type == "dem_progress_fn":
                    pre += ["if %s is None:" % m.name,
                            "    %s._%s = %s._callback(%s, _go_on, None)" % (a.name, m.name, world, camel(m.type))]
            note = None
            for m in members:
                if m.name in taken:
                    continue
                words = self.words(m)
                if hidden(m):
                    continue
                if m.doc and m.doc == note and not words:   # shares the comment of the field before it
                    docs[-1] = re.sub("(?=: )", ", " + m.name, docs[-1], count=1)
                elif m.doc or words:
                    docs.append("%s: %s" % (m.name, re.sub(r"\.; one of", ". One of", "; ".join(filter(None, (self.say(m.doc), words))))))
                note = m.doc
            if base:
                docs.insert(0, "Fields that are not given stay as they are.")
        if {"radii", "radius"} <= {p for p, _ in params}:
            pre.insert(0, "_one_radius(radii, radius, %r)" % (where + ": "))
        # -- parameters with a default are last --
        if any(default is None and params[i - 1][1] is not None for i, (_, default) in enumerate(params) if i):
            params = [(p, None) for p, _ in params]
        call = "_lib.%s(%s)" % (("dempy_" + f.name[4:]) if f.inline else f.name, ", ".join(pass_on))
        text = ", ".join((["self"] if owner else []) + [p if d is None else "%s=%s" % (p, d) for p, d in params]
                         + (["*"] if star else []) + ["%s=%s" % s for s in star])
        prop = owner and f.name.endswith("_get") and not params and not star
        variables = {a.name: a for a in f.arguments}
        kinds_ = [f.type] if f.type in h.structs and not f.star else [variables[o].type for o, size in outs if variables[o].type in h.structs
                                                                      and size is None]
        if fields:
            variables.update((m.name, m) for m in self.h.structs[fields[1]][0])
        hints, nulls = ["self"]*bool(owner), self.nulls.get(f.name, ())
        for p, d in params + [("*", "")]*bool(star) + star:
            hints.append(p if p == "*" else "%s: %s%s" % (
                p, "TextIO | None" if p == "out" else self.hint(variables[p], d == "None" or (p, d) in star or p in nulls), " = ..." if d is not None else ""))
        struct = kinds_[0] if prop and len(kinds_) == 1 and kinds_[0] not in self.ids else None
        if struct:
            self.parts.setdefault(HANDLES.get(owner) or camel(owner), {})[name] = camel(struct)
        self.typed.setdefault(owner, []).append("%s    def %s(%s) -> %s: ..." % (
            "    @property\n" if prop else "", name, ", ".join(hints), self.returned(f, owner, outs)))
        pad = "    " if owner else ""
        self.write("")
        if not owner:
            self.write("")
        if prop:
            self.write(pad + "@property")
        lines = textwrap.wrap("def %s(%s):" % (name, text), 118 - len(pad) - 8, break_long_words=False, break_on_hyphens=False)
        self.write("\n".join([pad + lines[0]] + [pad + "        " + line for line in lines[1:]]))
        made = self.returned(f, owner, outs)
        if made == "Structs":
            made = "Structs of " + camel(next(variables[o].type for o, size in outs))
        if made == "ctypes.Array[Any]":
            made = "Row"
        if re.search("[A-Z]", made) and not made.endswith("None"):
            made = re.sub(r"ctypes\.Array\[Any\]", "Row", made)
            docs.append("Returns: %s" % re.sub(r"^list\[(\w+)\]$", r"a list of \1", re.sub(r"^tuple\[(.*)\]$", r"\1", made)))
        self.write(doc_lines(len(pad) + 4, self.say(DOCS.get(f.name, f.doc)), docs))
        body = pre + self.ending(f, owner, world, call, outs, params)
        for line in body:
            inner = line[:len(line) - len(line.lstrip())]
            for piece in folded(line, 114 - len(pad), inner + "    "):
                self.write(pad + "    " + piece)
        if owner:
            self.names.setdefault(owner, []).append(name)

    def words(self, m):
        """The words that a field of an enum takes."""
        if m.type not in self.h.enums:
            return ""
        names = [v[0] for v in self.h.enums[m.type][0]]
        prefix = os.path.commonprefix(names)
        prefix = prefix[:prefix.rindex("_") + 1]
        return "one of " + ", ".join('"%s"' % name[len(prefix):].lower() for name in names)

    def setter(self, f, owner):
        """What changes the values that a function returns, as an argument of _with."""
        other = next((g for g in self.h.functions if g.name == f.name[:-4] + "_set" and self.owner(g) == owner), None)
        if f.name == "dem_wall_pose_get":
            return ", 'call wall.motion_set(...), which moves the wall from there on'"
        if not other:
            return ""
        return ", 'call %s.%s(...), which changes the fields that it is given'" % (camel(owner), self.short(other, owner))

    # -- types for editors: dem.pyi --
    def hint(self, var, null=False):
        """The annotation of an argument or a field."""
        t, more = var.type, " | None" if null else ""
        if var.call or t in self.h.calls:
            return "Callable[..., Any] | None"
        if var.pointer and t == "FILE":
            return "TextIO | None"
        if t == "char":
            return ("str | os.PathLike[str]" if var.name == "path" else "str | Sequence[str]" if var.name in (
                "groups", "body_reals", "law_memory_names", "columns") else "str") + (" | None" if null and var.pointer else "")
        if t == "void":
            return "str | bytes" if var.name == "data" else "Any"
        if t in HANDLES:
            return HANDLES[t]
        if t in ("dem_vec3", "dem_quat", "dem_box") and not var.dim and not (var.pointer and var.const):
            return "%s | _Numbers%s" % (camel(t), more)
        if t in self.h.enums:
            return "Sequence[%s | str | int]" % camel(t) if var.dim else "%s | str | int" % camel(t)
        if t in self.h.structs:
            one = camel(t) if t in self.ids else "%s | Mapping[str, Any]" % camel(t)
            many = var.dim or var.pointer and (var.name.endswith("s") and t not in ("dem_trials", "dem_grains", "dem_sizes", "dem_bodies")
                                               or var.name == "table")
            return ("Sequence[%s]" % one if many else one + (" | _Numbers" if t == "dem_region" else "")) + (more or " | None"*bool(many))
        if var.pointer or var.dim:
            return "_Array" + more
        return "float" if t in ("double", "dem_real") else "int"

    def returned(self, f, owner, outs):
        """The annotation of what a function returns."""
        h = self.h
        kinds = {a.name: a for a in f.arguments}

        def out(name, size):
            a = kinds[name]
            item = camel(a.type) if a.type in h.structs else "float" if NUMBERS[a.type] in ("ctypes.c_double", "Real") else "int"
            if f.type == "int" and f.name.endswith("classes_get"):
                return "list[float]"
            if f.type == "int" and size == "capacity" and a.type in h.structs and a.type not in self.ids and "finding" not in a.type:
                return "Structs"
            return "list[%s]" % item if f.type == "int" or a.type in self.ids and size else item if size is None else "ctypes.Array[Any]"
        if any(a.type == "FILE" for a in f.arguments):
            return "int | None" if f.type != "void" else "None"
        if f.type == "char":
            return "str"
        if f.name == "dem_bodies_get":
            return "Bodies"
        if f.type == "dem_result" or f.type == "int" and outs:
            shown = [out(name, size) for name, size in outs]
            if f.name.endswith("classes_get"):
                return "tuple[list[float], list[float]]"
            return "None" if not shown else shown[0] if len(shown) == 1 or f.type == "int" else "tuple[%s]" % ", ".join(shown)
        if f.type in HANDLES:
            return HANDLES[f.type]
        if f.type in h.structs:
            return camel(f.type)
        return {"void": "None", "double": "float", "dem_real": "float"}.get(f.type, "int")

    def stubs(self):
        """The text of dem.pyi."""
        h, out = self.h, [STUBS]
        for name, value, _ in h.constants:
            out.append("%s: int" % name[4:])
        out.append("VERSION: int\n__version__: str\n")
        for name, (values, _) in h.enums.items():
            names = [v[0] for v in values]
            prefix = os.path.commonprefix(names)
            prefix = "DEM_" if name == "dem_result" else prefix[:prefix.rindex("_") + 1]
            out.append("class %s(enum.IntEnum):" % camel(name))
            for value, number, _ in values:
                short = value[len(prefix):]
                out.append("    %s = %d" % ("_" + short if short[0].isdigit() else short, number))
            out.append("")
        out.append("class Error(Exception):\n    result: Result | None\n")
        for value, number, _ in h.enums["dem_result"][0]:
            if number:
                word = value[len("DEM_ERROR_"):]
                out.append("class %sError(Error%s): ..." % (camel(word.lower()), ", builtins." + BUILTIN[word] if word in BUILTIN else ""))
        for name, base in (("ArgumentTypeError", "TypeError"), ("ArgumentRangeError", "OverflowError"), ("FieldError", "AttributeError"),
                           ("LoadError", "ImportError")):
            out.append("class %s(Error, builtins.%s): ..." % (name, base))
        out.append("class NoSuchError(ArgumentError, builtins.IndexError): ...\nclass NoFieldError(ArgumentError, builtins.AttributeError): ...\n")
        for name, (fields, _) in h.structs.items():
            base = BASES.get(name) or ("Id" if name in self.ids else "Struct")
            out.append("class %s(%s):" % (camel(name), base))
            for f in fields:
                kind = self.hint(f, True)
                if f.pointer and f.type in NUMBERS or f.dim and f.type in NUMBERS:
                    kind = "Any"
                elif f.type in h.structs and not f.pointer and not f.dim:
                    kind = camel(f.type)
                elif f.dim and f.type == "char":
                    kind = "str"
                elif f.type in h.enums and not f.dim:
                    kind = camel(f.type)
                out.append("    %s: %s" % (f.name, kind))
            given = ", ".join("%s: %s = ..." % (f.name, self.hint(f, True)) for f in fields)
            star = "" if base in ("Vector", "Numbers", "Id") or len(fields) < 3 else "*values: Any, "
            out.append("    def __init__(self, %s%s) -> None: ..." % (star, given))
            out += self.typed.get(name, [])
            out.append("")
        for name in ("dem_world", "dem_replay", "dem_slabs"):
            out.append("class %s(%sBase):" % (HANDLES[name], HANDLES[name]))
            if name == "dem_world":
                out.append("    def __init__(self, *, %s) -> None: ..." % ", ".join(
                    "%s: %s = ..." % (m.name, self.hint(m, True)) for m in h.structs["dem_world_desc"][0]))
            out += self.typed.get(name, [])
            out.append("")
        out += [line.strip().replace("(self, ", "(") for line in self.typed.get(None, [])]
        return "\n".join(out) + "\n"

    def default(self, m):
        if m.call or m.pointer or m.type in self.h.calls or m.type in self.ids or m.type in self.h.structs:
            return "None"
        if m.dim:
            return "()"
        return "0"

    def ending(self, f, owner, world, call, outs, params):
        """The lines that call the function and return its result."""
        h = self.h
        if "FILE" in call:
            head, inner = call.split("(", 1)
            inner = inner[:-1].split(", ")
            inner.remove("FILE")
            if owner is None:
                return ["return Handle()._print(%s, out, %s)" % (head, ", ".join(inner))]
            end = "_print(%s, out, %s)" % (head, ", ".join(inner))
            return ["return %s.%s" % (world, end)]
        if not owner:
            if f.type == "char" and f.star:
                return ["return (%s or b'').decode()" % call]
            return ["return " + call]
        if f.name == "dem_group_get":
            return ["if not self.desc.groups:",
                    "    raise _no_groups(name)",
                    "found = " + call, "%s._ok(0)" % world, "if not found:", "    %s._raise(ArgumentError)" % world,
                    "found._of = %s" % world, "return found"]
        if f.name == "dem_body_id_get":
            return ["return %s.bodies[index]" % world]
        if f.type == "dem_result" and (re.search(r"_(step|run|run_to|settle)$", f.name)):
            head, inner = call.split("(", 1)
            run = "%s._ok(%s._run(%s, %s)" % (world, world, head, inner)
            if f.name.endswith("_step"):            # one step without functions of yours: nothing to interrupt
                return ["%s._ok(%s._run(%s, %s if type(steps) is not int or steps != 1 or %s._context.kept or %s._context.runs else %s)" % (
                    world, world, head, inner, world, world, call)]
            return [run] + (["return " + ", ".join(name for name, _ in outs)] if outs else [])
        if f.type == "dem_result":
            arrays = [a.name for a in f.arguments if a.pointer and a.const and a.type in NUMBERS]
            rows = ", grains" if f.name == "dem_grains_add" else ""
            if arrays and "count" in [a.name for a in f.arguments]:
                rows = ", dict(%s)" % ", ".join("%s=%s" % (name, name) for name in arrays)
            lines = ["%s._ok(%s%s)" % (world, call, rows)]
            if outs:
                shown = []
                for o, size in outs:
                    a = next(a for a in f.arguments if a.name == o)
                    if a.type in self.free:
                        lines.append("%s = %s._taken(%s, _lib.%s)" % (o, world, o, self.free[a.type]))
                    elif a.type in h.structs and size is None:
                        lines.append("%s._with(%s%s)" % (world, o, self.setter(f, owner)))
                    if a.type in self.ids and size:
                        lines.append("%s = [item.of(%s) for item in %s]" % (o, world, o))
                    shown.append(o)
                lines.append("return " + ", ".join(shown))
            return lines
        if f.type in self.ids:
            if f.name.endswith("_get"):
                return ["found = " + call, "%s._ok(0)" % world, "found._of = %s" % world, "return found if found else None"]
            return ["return %s._id(%s)" % (world, call)]
        if f.star:
            if f.type == "char":
                return ["return (%s or b'').decode()" % call]
            kind = HANDLES[f.type]
            return ["return %s(%s._pointer(%s), %s%s)" % (kind, world, call, world, ", path" if "path" in dict(params) else "")]
        if f.type in h.structs:
            return ["if not self.desc.ledger:", "    raise _no_ledger()"]*(f.name == "dem_ledger_get") + ["found = " + call, "%s._ok(0)" % world, "return %s._with(found%s)" % (
                world, ", _world_call" if f.name == "dem_world_desc_get" else "")]
        if f.type == "int" and outs:
            o, size = outs[0]
            kinds = {a.name: a.type for a in f.arguments}
            if f.name.endswith("classes_get"):
                return ["found = %s" % call, "%s._filled(found, 0, %r)" % (world, f.name),
                        "return %s" % ", ".join("list(%s[:found])" % o for o, _ in outs)]
            if size == "capacity" and "finding" not in o:
                return ["count = %s._number(%s)" % (world, call), "array = _row(%s._type_, count).from_buffer(%s)" % (o, o),
                        "return [item.of(%s) for item in array]" % world if kinds[o] in self.ids else
                        "return Structs(array)" if kinds[o] in h.structs else "return array"]
            return ["count = %s._number(%s)" % (world, call), "return list(_fixed(%s)[:min(count, len(%s))])" % (o, o)]
        if f.type == "int" and re.search(r"_(fill|pack)$", f.name):
            return ["return %s._filled(%s, count, %r)" % (world, call, f.name)]
        if f.type == "int" or f.name == "dem_sizes_finer_get":
            return ["return %s._number(%s)" % (world, call)]
        if f.type == "void":
            return [call, "%s._ok(0)" % world]
        return ["found = " + call, "%s._ok(0)" % world, "return found"]

    def handle(self, name, init):
        """A class of a pointer that the library owns."""
        functions = [f for f in self.h.functions if self.owner(f) == name]
        hidden = {"dem_progress_print", "dem_world_destroy", "dem_replay_close", "dem_slabs_destroy"} | set(self.free.values())
        self.write(init)
        for f in functions:
            if f.name not in hidden:
                self.method(f, name)

    def errors(self):
        self.write("\n# ---- errors, one for each result " + "-"*66)
        self.enum("dem_result")
        self.write(ERROR)
        self.write("\n\n_ERRORS = {}")
        for value, number, note in self.h.enums["dem_result"][0]:
            if number:
                word = value[len("DEM_ERROR_"):]
                base = ", " + BUILTIN[word] if word in BUILTIN else ""
                self.write("\n\nclass %sError(Error%s):" % (camel(word.lower()), base))
                self.write(doc_lines(4, note))
                self.write("    result = Result.ERROR_%s" % word)
                self.write("\n\n_ERRORS[%d] = %sError" % (number, camel(word.lower())))
        self.write(WRONG)

    def file(self):
        h = self.h
        self.names, self.parts, self.constants = {}, {}, {}
        self.write(HEAD)
        for name, value, note in h.constants:
            self.write("%s = %s%s" % (name[4:], value, "    # " + note if note else ""))
        self.write("VERSION = VERSION_MAJOR*10000 + VERSION_MINOR*100 + VERSION_PATCH")
        self.write('__version__ = "%d.%d.%d" % (VERSION_MAJOR, VERSION_MINOR, VERSION_PATCH)')
        inline = [f for f in h.functions if f.inline and not f.name.endswith("_make")]
        self.write("# inline functions of dem.h, which the library exports under other names\n_INLINE = r\"\"\"")
        for f in inline:
            args = ", ".join("%s%s %s%s" % ("const " if a.const else "", a.type, "*"*a.pointer, a.name) for a in f.arguments)
            self.write("%s dempy_%s(%s) { %s%s(%s); }" % (f.result, f.name[4:], args, "" if f.type == "void" else "return ", f.name,
                                                          ", ".join(a.name for a in f.arguments)))
        self.write('"""\n')
        self.write("_LAW_NEEDS = {      # numbers of contact history that a built-in law needs, and leading vectors among them")
        needs = {}
        for f in inline:
            found = re.search(r"Contact history: (\d+) reals?\b(, the vector)?", f.doc)
            as_for = re.search(r"Contact history as for dem_(\w+)", f.doc)
            if f.name.startswith("dem_law_") and len(f.arguments) == 3 and f.arguments[1].name == "memory":
                needs[f.name[4:]] = needs[as_for.group(1)] if as_for else (
                    int(found.group(1)), int(bool(found.group(2)))) if found else (0, 0)
                if not (found or as_for or "o contact history" in f.doc):
                    fail("the comment of %s does not say what contact history it needs" % f.name)
                self.write("    %r: %r," % (f.name[4:], needs[f.name[4:]]))
        self.write("}\n")
        self.write("_LAW_READS = {      # fields of the force that a friction or rolling law reads, which a normal law sets")
        for law in needs:
            fields = h.reads("dem_" + law)
            if fields:
                self.write("    %r: %r," % (law, tuple(fields)))
        self.write("}\n")
        self.errors()
        with open(os.path.join(HERE, "base.py")) as file:
            self.write(file.read())
        self.write("\n# ---- enums " + "-"*87)
        for name in h.enums:
            if name != "dem_result":
                self.enum(name)
        done = set()

        def need(name):
            if name in done:
                return
            done.add(name)
            if name in h.calls:
                for a in h.calls[name].arguments:
                    if a.type in h.structs:
                        need(a.type)
                if h.calls[name].type in h.structs:
                    need(h.calls[name].type)
                self.wrap(h.calls[name])
            elif name in h.structs:
                for f in h.structs[name][0]:
                    need(f.type)
                    for a in f.call.arguments if f.call else ():
                        need(a.type)
                self.struct(name)
        for name in h.structs:
            need(name)
        for name in h.calls:
            need(name)
        self.write("\n\nstructs = [%s]" % ", ".join(camel(n) for n in h.structs))
        create = next(f for f in h.functions if f.name == "dem_world_create_checked")
        members = h.structs["dem_world_desc"][0]
        text = ", ".join(["self", "*"] + ["%s=%s" % (m.name, self.default(m)) for m in members])
        lines = textwrap.wrap("def __init__(%s):" % text, 106)
        docs, note = [], None
        for m in members:
            words = self.words(m)
            if (m.doc or words) and (m.doc != note or words) and m.type != "void":
                docs.append("%s: %s" % (m.name, re.sub(r"\.; one of", ". One of", "; ".join(filter(None, (self.say(m.doc), words))))))
            note = m.doc
        init = WORLD % ("\n".join(["    " + lines[0]] + ["            " + line for line in lines[1:]]),
                        doc_lines(8, "Creates an empty world. ArgumentError says which value is out of range.", docs),
                        textwrap.fill("self._create(WorldDesc._of_call(\"World\", dict(%s)))" % ", ".join("%s=%s" % (m.name, m.name) for m in members), 108,
                                      initial_indent=" "*8, subsequent_indent=" "*12))
        h.functions.remove(create)
        self.create = create
        self.handle("dem_world", init)
        self.handle("dem_replay", REPLAY)
        self.handle("dem_slabs", SLABS)
        skip = {"dem_progress_print", "dem_world_create_error_get"}
        for f in h.functions:
            if self.owner(f) is None and not f.name.endswith("_make") and f.name not in skip:
                self.method(f, None)
        self.write("\n\n_CONSTANTS = {      # constants of enums, as error messages of Python show them")
        for value in sorted(self.constants):
            self.write("    %r: %r," % (value, self.constants[value]))
        self.write("}")
        self.write("\n\n_FUNCTIONS = [")
        for f in [create] + h.functions:
            if f not in inline and f.inline:
                continue
            for line in folded(self.signature(f) + ",", 114, " "):
                self.write("    " + line)
        for name, result, arguments in EXTRA:
            self.write("    (%r, %s, [%s], %r, ['self']*%d)," % (name, result, arguments, name, len(arguments.split(", "))))
        self.write("]")
        self.write("\nfor _name in %s:" % '[name for name in Bodies.kinds if name not in ("count", "real_count")]')
        self.write("    setattr(Rows, _name, _row_property(_name, next(doc for name, _, doc in Bodies.rows if name == _name)))")
        self.write("_PARTS = {      # structs that properties return")
        for owner, parts in self.parts.items():
            for line in folded("%r: {%s}," % (owner, ", ".join("%r: %s" % pair for pair in parts.items())), 114, "    "):
                self.write("    " + line)
        self.write("}")
        self.write("_bind_all(globals())")
        self.write('__all__ = [_name for _name, _value in globals().items() if _name[0] != "_" and not isinstance(_value, types.ModuleType)')
        self.write("           and not hasattr(builtins, _name)]")
        for owner, names in self.names.items():
            for name in names:
                if names.count(name) > 1:
                    fail("two functions become %s.%s" % (owner, name))
        return "\n".join(self.out) + "\n"


# what holds the lengths of arrays whose comments do not say it; "_per_body": the numbers on bodies of the world
LENGTHS = {"dem_contact_who": "_per_body", "dem_body_state": "_per_body", "dem_contact_rows": "count",
           "dem_bodies": "count"}
KNOWN = {("dem_wall_loads", "contacts")}        # numbers of the last step that dem.h keeps when bodies or walls change
SPOILING = {"dem_%s_fn" % name for name in "law law_rows law_rate reals body_force motion".split()}  # state is lost if they fail
SPRINGS, IMPULSES, CSV = "response=springs", "response=impulses", "kind=csv"
# Fields that have a use beside other fields only, as their comments say. kind=word|word: where the field `kind` is one
# of these words; other: where the other is given; !other: where it is not.
USES = {
    "dem_motion": {
        "velocity": "kind=translating|oscillating|servo", "speed": "kind=rotating", "amplitude": "kind=oscillating",
        "frequency": "kind=oscillating", "phase": "kind=oscillating", "function": "kind=user",
        "start": "kind=translating|rotating|oscillating|table|servo",
        "ramp": "kind=translating|rotating|oscillating|servo", "load": "kind=servo !table",
        "area": "kind=servo", "travel": "kind=servo", "table": "kind=table|servo", "table_repeats": "kind=table"},
    "dem_world_desc": {
        "thickness": "planar", "normal_law": SPRINGS, "tangent_law": SPRINGS + " !law",
        "rolling_law": SPRINGS + " !law", "tension": SPRINGS, "friction_load": SPRINGS, "slider": SPRINGS,
        "convention": SPRINGS, "law_memory": "law", "law_stiffness": "law", "growth_interval": "growth",
        "cone": IMPULSES, "solver": IMPULSES, "sweeps": IMPULSES, "tolerance": IMPULSES, "cold_start": IMPULSES,
        "unsolved_stops": IMPULSES},
    "dem_sizes": {
        "median": "kind=lognormal|normal", "spread": "kind=lognormal", "scale": "kind=weibull|exponential",
        "modulus": "kind=weibull", "radius": "kind=sieve_curve", "passing": "kind=sieve_curve",
        "deviation": "kind=normal"},
    "dem_joint_desc": {
        "axis": "kind=revolute", "motor": "kind=revolute", "speed": "motor=speed", "torque": "motor=speed|torque",
        "wall": "!b"},
    "dem_output_desc": {
        "wall": CSV, "columns": CSV, "values": CSV, "mixing": CSV, "outlet": CSV, "function": "kind=call",
        "field": "kind=field_csv", "z0": "kind=walls", "z1": "kind=walls"},
    "dem_cluster_desc": {"rays": "mass=union", "volume": "mass=given", "centre": "mass=given", "inertia": "mass=given"},
    "dem_cell_desc": {"stress": "rate_most"}, "dem_rail_desc": {"velocity": "axes", "spin": "axes", "wall": "axes"},
    "dem_mixing_desc": {"centre": "axis"}, "dem_events_desc": {"begins": "function"}}
DEFAULTS = {"dem_world_desc": {"thickness": 1}}
PRESSES = "velocity is the direction in which the wall presses; reverse it to press the other way"
POSITIVE = {"dem_motion": {"load": PRESSES}, "dem_motion_row": {"load": PRESSES}}
NEEDS = {"dem_motion": {"translating": ("velocity",), "rotating": ("speed",), "oscillating": ("amplitude", "frequency"), "servo": ("load table",)}}
BASES = {"dem_vec3": "Vector", "dem_quat": "Numbers"}
# functions that dem.py adds to the library; loaded where they are there
EXTRA = [("dempy_rows", "ctypes.c_int", "ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t, ctypes.c_int, ctypes.c_void_p"),
         ("dempy_ids", "ctypes.c_int", "ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p"),
         ("dempy_put", "ctypes.c_int", "ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p")]

ERROR = '''

class Error(Exception):
    """A call of dem.h has failed. The text is the error message of dem.h: the function, what is wrong with the value,
    the limit, the likely cause, the remedy. result: the dem.Result."""
    result = None
'''

WRONG = '''

class ArgumentTypeError(Error, TypeError):
    """An argument or a field has a wrong type. The text names the call, the argument, what is given and what is wanted."""
    result = Result.ERROR_ARGUMENT


class ArgumentRangeError(Error, OverflowError):
    """A number does not fit into the type of C."""
    result = Result.ERROR_ARGUMENT


class FieldError(Error, AttributeError):
    """An assignment to what cannot be set. The text names the call that changes it."""
    result = Result.ERROR_ARGUMENT


class LoadError(Error, ImportError):
    """The library cannot be compiled or loaded."""


class NoSuchError(ArgumentError, IndexError):
    """There is no body, element or row of this number."""


class NoFieldError(ArgumentError, AttributeError):
    """There is no field or attribute of this name."""
'''

ZEROS = {("dem_world_settle", "speed"), ("dem_effects_get", "budget"), ("dem_effects_print", "budget"),
         ("dem_ellipsoids_contact_get", "lambda_"), ("dem_temperature_set", "seed"),
         ("dem_shape_mesh_add", "dent"), ("dem_sieve_blinded_get", "speed"), ("dem_spheres_pack", "count")}

HEAD = '''"""dem.py gives dem.h to Python: ctypes and the standard library, nothing else. MIT licence.

    import dem
    world = dem.World(gravity=(0, 0, -9.81))
    glass = world.material(density=2500, young=1e7, poisson=0.25, restitution=0.5, friction=0.5)
    world.wall_plane(glass, (0, 0, 0), (0, 0, 1))
    ball = world.sphere(glass, 0.01, (0, 0, 0.1))
    world.run(0.5)
    print(ball.state.position)

make.py made this file from dem.h and base.py: change those, then `make python`. docs/python.md is the manual. The texts
below are the comments of dem.h with the names of Python. Rules of names:

    dem_world_step(world, 1)                world.step(1)           functions of a world are methods
    dem_sphere_add(world, ...)              world.sphere(...)       _add, _get, _open, _create are dropped
    dem_counters_get(world)                 world.counters          _get without arguments: a property
    dem_wall_loads_get(world, wall, &l)     wall.loads              functions of an id are its methods
    dem_body_get(world, body, &state)       body.state              named after the struct that it returns
    dem_body_set(world, body, &state)       body.set(velocity=...)  only these fields change
    dem_quat_multiply(a, b)                 dem.quat_multiply(a, b) others are functions of the module
    dem_vec3_make(1, 2, 3)                  dem.Vec3(1, 2, 3), or the tuple (1, 2, 3)
    DEM_NORMAL_LINEAR                       dem.NormalLaw.LINEAR, or the word "linear"
    DEM_ERROR_TIME_STEP                     raises dem.TimeStepError, whose text is the error message
    struct dem_motion                       dem.Motion, or keyword arguments: wall.motion_set(kind="rotating", ...)
"""
import builtins
import ctypes
import enum
import functools
import gc
import hashlib
import html
import io
import math
import operator
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import types
import warnings
import weakref
try:
    import _signal              # signal.signal takes 15 us
except ImportError:
    _signal = signal
_refs = sys.getrefcount
'''

STUBS = '''# Types of dem.py for editors and type checkers. make.py made this file from dem.h: `make python`.
import builtins
import ctypes
import enum
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TextIO

_Numbers = Sequence[Any]        # as many as fields, such as (0, 0, 1)
_Array = Any                    # lists, nested or flat, buffers, arrays of numpy, tables of pandas
Real: type

def build(header: str | None = ..., folder: str | None = ...) -> str: ...
def load(path: str | None = ...) -> None: ...
def compile(source: str | os.PathLike[str], flags: str | Sequence[str] = ...) -> ctypes.CDLL: ...
def tail(memory: Any, first: int) -> Any: ...
def progress_print(world: World, done: float, seconds_left: float) -> None: ...

class Struct(ctypes.Structure):
    def __iter__(self) -> Iterator[Any]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __setitem__(self, index: Any, value: Any) -> None: ...
    def keys(self) -> list[str]: ...
    def to_dict(self) -> dict[str, Any]: ...
    @classmethod
    def make(cls, value: Any) -> Any: ...

class Numbers(Struct):
    def __array__(self, dtype: Any = ..., copy: Any = ...) -> Any: ...
    def __add__(self, other: Any) -> Any: ...
    def __radd__(self, other: Any) -> Any: ...
    def __sub__(self, other: Any) -> Any: ...
    def __rsub__(self, other: Any) -> Any: ...
    def __mul__(self, other: Any) -> Any: ...
    def __rmul__(self, other: Any) -> Any: ...
    def __truediv__(self, other: Any) -> Any: ...
    def __iadd__(self, other: Any) -> Any: ...
    def __isub__(self, other: Any) -> Any: ...
    def __imul__(self, other: Any) -> Any: ...
    def __itruediv__(self, other: Any) -> Any: ...
    def __neg__(self) -> Any: ...
    def __abs__(self) -> float: ...
    def dot(self, other: Any) -> float: ...

class Vector(Numbers):
    def cross(self, other: Any) -> Any: ...

class Id(Struct):
    def of(self, world: World) -> Any: ...
    @property
    def world(self) -> World: ...

class Handle:
    def close(self) -> None: ...
    def __enter__(self) -> Any: ...
    def __exit__(self, *_: Any) -> None: ...

class WorldBase(Handle):
    gravity: Any
    dt: float
    @property
    def bodies(self) -> Rows: ...
    def __len__(self) -> int: ...

class ReplayBase(Handle):
    @property
    def path(self) -> str: ...

class SlabsBase(Handle): ...

class Structs:
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __array__(self, dtype: Any = ..., copy: Any = ...) -> Any: ...
    def to_dict(self) -> dict[str, list[Any]]: ...

class Array:
    view: memoryview
    @property
    def shape(self) -> tuple[int, ...]: ...
    ndim: int
    nbytes: int
    itemsize: int
    readonly: bool
    format: str
    def __init__(self, view: Any) -> None: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __setitem__(self, index: Any, value: Any) -> None: ...
    def __iter__(self) -> Iterator[Any]: ...
    def __array__(self, dtype: Any = ..., copy: Any = ...) -> Any: ...
    def tolist(self) -> list[Any]: ...
    def tobytes(self) -> bytes: ...

class Row(ctypes.Array[Any]):
    def __add__(self, other: Any) -> Any: ...
    def __radd__(self, other: Any) -> Any: ...
    def __sub__(self, other: Any) -> Any: ...
    def __rsub__(self, other: Any) -> Any: ...
    def __mul__(self, other: Any) -> Any: ...
    def __rmul__(self, other: Any) -> Any: ...
    def __truediv__(self, other: Any) -> Any: ...
    def __iadd__(self, other: Any) -> Any: ...
    def __isub__(self, other: Any) -> Any: ...
    def __imul__(self, other: Any) -> Any: ...
    def __itruediv__(self, other: Any) -> Any: ...

class Page:
    def __init__(self, path: str | os.PathLike[str], height: int = ...) -> None: ...

class Rows:
    count: int
    real_count: int
    positions: Any
    velocities: Any
    spins: Any
    forces: Any
    torques: Any
    masses: Any
    slots: Any
    materials: Any
    orientations: Any
    shapes: Any
    reals: Any
    rates: Any
    groups: Any
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...
    def __iter__(self) -> Iterator[Body]: ...
    def to_dict(self) -> dict[str, list[Any]]: ...
'''

WORLD = '''

class World(WorldBase):
    """A world: everything that one simulation consists of."""

%s
%s%s'''

REPLAY = '''

class Replay(ReplayBase):
    """A replay: world.replay(path) opens it, close() or the end of a `with` block completes the file. Jupyter shows a
    replay that is closed."""
'''

SLABS = '''

class Slabs(SlabsBase):
    """The slabs that one process holds."""
'''

if __name__ == "__main__":
    paths = [argument for argument in sys.argv[1:] if argument != "--stubs"]
    path = paths[0] if paths else os.path.join(HERE, "..", "..", "dem.h")
    with open(path) as file:
        writer = Writer(Header(file.read()))
    text = writer.file()
    if "--stubs" in sys.argv:
        text = writer.stubs()
    sys.stdout.write(text)
