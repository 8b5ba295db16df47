# The part of examples/upgrade.sh that rewrites. It reads the rows of upgrade.txt, looks at all files for variables and
# members of structs (pass 1), and writes each file with present names (pass 2): of file k the text to TO/k.new, and
# what is left to the user to TO/k.notes, a line per place. TABLE, TO and OPEN (numbers of the files whose last line
# does not end) are variables of the environment.
#
# A file is a list of tokens: kind[i], text[i], row[i] (its line). Kinds: i identifier, d number, p punctuation,
# s string or character, c comment, w blanks, n end of a line, x untouched. Tokens of the kinds i, d, p and s count;
# before[i] and after[i] are the neighbours of token i that count, and mate[i] of a bracket is the other one.
BEGIN {
    table(ENVIRON["TABLE"])
    n = split("return else goto case sizeof new delete throw typename using namespace if while for switch do " \
        "operator template public private protected default break continue not and or defined include define " \
        "ifdef ifndef endif elif undef pragma error line co_return co_await co_yield alignof decltype", word, " ")
    for (i = 1; i <= n; i++) not_type[word[i]]
    n = split("const volatile static extern register inline constexpr mutable restrict __restrict struct union class " \
        "typedef thread_local _Thread_local", word, " ")
    for (i = 1; i <= n; i++) qualifier[word[i]]
    n = split("void char short int long float double signed unsigned bool auto size_t FILE int32_t uint32_t int64_t " \
        "uint64_t uint8_t", word, " ")
    for (i = 1; i <= n; i++) plain_type[word[i]]
    for (file = 1; file < ARGC; file++) { tokens(ARGV[file]); declarations(1) }
    for (file = 1; file < ARGC; file++) { tokens(ARGV[file]); declarations(0); rewrite() }
}

# --- the tables

function table(path,    line, part, n, code, kind_of, remedy, at, number) {
    while ((code = (getline line < path)) > 0) {
        number++
        sub(/\r$/, "", line)
        if (line ~ /^[ \t]*(#|$)/) continue
        while (sub(/ *\\$/, "", line) && (getline remedy < path) > 0) {
            number++; sub(/^[ \t]*/, " ", remedy); sub(/\r$/, "", remedy); line = line remedy
        }
        remedy = ""
        if ((at = index(line, " :: ")) > 0) { remedy = substr(line, at + 4); line = substr(line, 1, at - 1) }
        n = split(line, part, " "); kind_of = part[1]
        if (kind_of == "name" && n >= 3 && n <= 4) {
            new_name[part[2]] = part[3]; only_with[part[2]] = part[4]; said[part[2]] = remedy
        } else if (kind_of == "call" && index(line, "=>")) call_row(line, remedy)
        else if (kind_of == "call" && n == 2 && remedy) fallback[part[2]] = remedy
        else if (kind_of == "field" && (n == 4 || (n == 3 && remedy))) {
            field_row[++fields] = part[2] SUBSEP part[3]; field_new[fields] = part[4]; field_said[fields] = remedy
            is_field[part[3]] = is_field[part[3]] " " part[2]
        } else if (kind_of == "gone" && n == 2 && remedy) gone[part[2]] = remedy
        else if (kind_of == "check" && n == 2 && remedy) check[part[2]] = remedy
        else if (kind_of == "order" && n == 2 && remedy) order[part[2]] = remedy
        else if (kind_of == "member" && n == 3) member[part[2]] = part[3]
        else if (kind_of == "returns" && n == 3) returns[part[2]] = part[3]
        else { print path ":" number ": this is no row of a table: " line; bad_table = 1 }
    }
    close(path)
    if (code < 0) print path ": cannot be read"
    if (code < 0 || bad_table) exit 2
    for (n = 1; n <= fields; n++) {               # under the present name of the struct
        split(field_row[n], part, SUBSEP)
        to_field[present(part[1]), part[2]] = field_new[n]; to_said[present(part[1]), part[2]] = field_said[n]
    }
    for (kind_of in member) member[kind_of] = present(member[kind_of])
    for (kind_of in returns) returns[kind_of] = present(returns[kind_of])
}
function present(type) { return type in new_name ? new_name[type] : type }
function call_row(line, remedy,    at, pattern, name, part, n, i) {
    sub(/^[ \t]*call[ \t]+/, "", line)
    at = index(line, "=>")
    pattern = substr(line, 1, at - 1); line = substr(line, at + 2)
    sub(/^ +/, "", line); sub(/ +$/, "", line); gsub(/ /, "", pattern)
    at = index(pattern, "(")
    name = substr(pattern, 1, at - 1); pattern = substr(pattern, at + 1); sub(/\)$/, "", pattern)
    call_name[++calls] = name; call_new[calls] = line; call_said[calls] = remedy
    rows_of[name] = rows_of[name] " " calls
    if (index(line, name "(") == 1) still[name]                          # the name of a present function
    call_args[calls] = n = split(pattern, part, ",")
    for (i = 1; i <= n; i++) call_arg[calls, i] = part[i]
}

# --- tokens

function token(k, s) { kind[++count] = k; text[count] = s; row[count] = lines }
function tokens(path,    line, i, last, depth, stack) {
    split("", kind); split("", text); split("", row); split("", includes)
    count = lines = in_comment = in_line = in_string = 0; raw = ""
    cplusplus = path ~ /\.(cc|cpp|cxx|C|hh|hpp|hxx|mm)$/
    while ((getline line < path) > 0) { lines++; scan(line); token("n", "\n") }
    close(path)
    split("", before); split("", after); split("", mate)
    last = depth = 0
    for (i = 1; i <= count; i++) {
        if (kind[i] !~ /[idps]/) continue
        if (text[i] == "\\" && kind[i + 1] ~ /[nw]/) continue            # goes on in the next line
        before[i] = last; if (last) after[last] = i; else first = i
        last = i
        if (kind[i] != "p") continue
        if (index("({[", text[i])) stack[++depth] = i
        else if (index(")]}", text[i])) {
            if (depth && index("()[]{}", text[stack[depth]] text[i])) { mate[i] = stack[depth]; mate[stack[depth]] = i }
            if (depth) depth--
        }
    }
    if (!last) first = 0
}
function scan(line,    e, c, open_end) {
    if (match(line, /^[ \t]*#[ \t]*include/) && !in_comment && raw == "" && !in_string && !in_line) {
        token("x", line)
        sub(/^[ \t]*#[ \t]*include[ \t]*[<"]/, "", line); sub(/[>"].*/, "", line); sub(/.*\//, "", line)
        includes[line]
        return
    }
    open_end = line ~ /\\\r?$/
    while (line != "") {
        c = substr(line, 1, 1)
        if (in_line) { token("c", line); line = "" }
        else if (in_comment) {
            e = index(line, "*/"); in_comment = !e
            if (!e) e = length(line)
            else e++
            token("c", substr(line, 1, e)); line = substr(line, e + 1)
        } else if (raw != "") {
            e = index(line, raw)
            if (e) { e += length(raw) - 1; raw = "" } else e = length(line)
            token("x", substr(line, 1, e)); line = substr(line, e + 1)
        } else if (in_string || c == "\"") {
            e = index(line, "(")
            if (!in_string && e && kind[count] == "i" && text[count] ~ /^(u8|u|U|L)?R$/) {
                raw = ")" substr(line, 2, e - 2) "\""
                token("x", substr(line, 1, e)); line = substr(line, e + 1)
                continue
            }
            match(line, in_string ? "^([^\"\\\\]|\\\\.)*\"?" : "^\"([^\"\\\\]|\\\\.)*\"?")
            e = RLENGTH
            in_string = !(substr(line, e, 1) == "\"" && (in_string || e > 1)) && open_end
            if (in_string || e < 1) e = length(line)
            token("s", substr(line, 1, e)); line = substr(line, e + 1)
        } else if (c == "'") {
            e = match(line, /^'([^'\\]|\\.)*'/) && RLENGTH < 13 ? RLENGTH : 1     # or an apostrophe in a text
            token(e > 1 ? "s" : "p", substr(line, 1, e)); line = substr(line, e + 1)
        } else if (match(line, /^[A-Za-z_][A-Za-z0-9_]*/)) {
            token("i", substr(line, 1, RLENGTH)); line = substr(line, RLENGTH + 1)
        } else if (match(line, /^[ \t\r\f\v]+/)) {
            token("w", substr(line, 1, RLENGTH)); line = substr(line, RLENGTH + 1)
        } else if (match(line, /^\.?[0-9]([eEpP][-+]|[0-9A-Za-z_.]|'[0-9A-Za-z])*/)) {
            token("d", substr(line, 1, RLENGTH)); line = substr(line, RLENGTH + 1)
        } else if (substr(line, 1, 2) == "//") { token("c", line); in_line = open_end; return }
        else if (substr(line, 1, 2) == "/*") {
            e = index(substr(line, 3), "*/"); in_comment = !e
            e = e ? e + 3 : length(line)
            token("c", substr(line, 1, e)); line = substr(line, e + 1)
        } else {
            e = substr(line, 1, 2) == "->" ? 2 : 1
            token("p", substr(line, 1, e)); line = substr(line, e + 1)
        }
    }
    if (in_line) in_line = open_end
}

# --- types of variables, members and functions, and fields. collect: 1 notes only what other files may use

function declarations(collect,    i, t) {
    split("", type_at); split("", any_type); split("", type_of_token); split("", seen_type)
    split("", field_do); split("", noted); split("", notes)
    depth_now = parens = note_count = 0
    for (i = first; i; i = after[i]) {
        t = text[i]
        if (kind[i] == "i") {
            if (!(i in type_of_token)) declared(i, collect)
            if (!collect) field(i)
            if (!collect && parens && text[after[i]] ~ /^[,)]$/) seen_type[i] = expression(i)
            if (t == "typedef" && text[after[i]] ~ /^dem_/ && kind[after[after[i]]] == "i")
                alias[text[after[after[i]]]] = present(text[after[i]])
        } else if (kind[i] != "p") continue
        else if (t == "(") parens++
        else if (t == ")") { if (parens) parens-- }
        else if (t == "{") opened(i)
        else if (t == "}") {
            forget(depth_now + 1)
            if (depth_now) { forget(depth_now); parens = outer_parens[depth_now--] }
        } else if (t == ";" && !parens) forget(depth_now + 1)
    }
}
function forget(d,    part, n, i) {
    n = split(names_at[d], part, " ")
    for (i = 1; i <= n; i++) delete type_at[part[i], d]
    names_at[d] = ""
}
function struct_type(t) { return t ~ /^dem_[a-z0-9_]+$/ || t in own_type || t in alias }
# a declaration that begins with the type in token i: TYPE * NAME, * NAME ... up to the end of the list
function declared(i, collect,    p, q, t, stars, name, type, tagged, inner) {
    t = text[i]
    if (t in not_type || t in qualifier) return
    p = before[i]
    tagged = text[p] ~ /^(struct|union|class)$/
    if (p && kind[p] == "p" && (text[p] == "" || !index(";{}(,:)>&", text[p]))) return
    if (text[p] == "&" || text[p] == ">" || text[p] == ")") { if (!struct_type(t)) return }
    if (p && kind[p] == "i" && !(text[p] in qualifier || text[p] in plain_type)) return
    if (kind[p] == "s" || kind[p] == "d") return
    stars = 0
    for (q = after[i]; text[q] ~ /^[*&]$/ || text[q] in qualifier; q = after[q]) if (text[q] ~ /^[*&]$/) stars++
    if (tagged && text[after[i]] ~ /^[{:]$/) { own_type[t]; return }
    if (kind[q] != "i" || text[q] in not_type) return
    if (stars && !(tagged || struct_type(t) || t in plain_type)) return
    type = t in alias ? alias[t] : present(t)
    for (;;) {                                                           # a declarator: its name is token q
        name = text[q]; p = after[q]
        if (text[p] == "" || !index("=;,)[({:", text[p])) return
        type_of_token[q]
        if (text[p] == "(" && !stars_paren(p)) { if (!(name in returns) || returns[name] == type) returns[name] = type }
        if (depth_now && block[depth_now] == "struct" && !parens)
            same(member, name, type)
        else {
            inner = parens ? depth_now + 1 : depth_now
            if (!((name, inner) in type_at)) names_at[inner] = names_at[inner] " " name
            type_at[name, inner] = type
            same(any_type, name, type)
            if (collect && !inner) same(global, name, type)
        }
        while (p && text[p] !~ /^[;,)}]$/) p = (p in mate) && mate[p] > p ? after[mate[p]] : after[p]
        if (text[p] != ",") return
        for (q = after[p]; text[q] ~ /^[*&]$/ || text[q] == "const"; q = after[q]) { }
        if (kind[q] != "i" || text[after[q]] == "" || !index("=;,[)", text[after[q]])) return
        if (parens && text[after[q]] ~ /^[,)]$/) return
    }
}
# notes the type of a name; "?" if it has two
function same(types, name, type) {
    if (!(name in types)) types[name] = type
    else if (types[name] != type) types[name] = "?"
}
function stars_paren(p) { return text[after[p]] == "*" }
function variable(name,    d) {
    for (d = depth_now + 1; d >= 0; d--) if ((name, d) in type_at) return known(type_at[name, d])
    if (name in any_type) return known(any_type[name])
    return name in global ? known(global[name]) : ""
}
function known(type) { return type == "?" || type == "auto" ? "" : type }
# the type of the expression that ends with token j, without pointers; "" if it cannot be known
function expression(j,    p, q) {
    while (text[j] == "]" && (j in mate)) j = before[mate[j]]
    if (kind[j] == "i") {
        p = before[j]
        if (text[p] == "." || text[p] == "->") return text[j] in member ? known(member[text[j]]) : ""
        return variable(text[j])
    }
    if (text[j] != ")" || !(j in mate)) return ""
    p = mate[j]; q = before[p]
    if (kind[q] == "i" && !(text[q] in not_type)) return text[q] in returns ? known(returns[text[q]]) : ""
    for (p = after[p]; text[p] == "*" || text[p] == "&"; p = after[p]) { }
    if (text[p] == "(" && (p in mate) && (q = cast(p)) != "") return q
    return expression(before[j])
}
# the type in the parentheses that begin with token p if they hold a type and nothing else, as those of casts
function cast(p,    q, type) {
    for (q = after[p]; q && q < mate[p]; q = after[q]) {
        if (text[q] in qualifier || text[q] == "*") continue
        if (text[q] == "[" && (q in mate)) { q = mate[q]; continue }
        if (type != "" || kind[q] != "i" || !struct_type(text[q])) return ""
        type = text[q] in alias ? alias[text[q]] : present(text[q])
    }
    return type
}
# an opening brace: block[] is what it holds, struct, init or block; of an initialiser init_type[], and init_array[]
function opened(i,    p, q, kind_of, type, array, c) {
    p = before[i]; kind_of = "block"; type = ""; array = 0
    if (text[p] == "=") {
        kind_of = "init"
        for (q = before[p]; text[q] == "]" && (q in mate); q = before[mate[q]]) array = 1
        if (kind[q] == "i")
            type = text[before[q]] != "." || !depth_now || block[depth_now] != "init" ? variable(text[q]) : \
                text[q] in member ? known(member[text[q]]) : ""
        else if (array && depth_now) { type = init_type[depth_now]; array = 0 }
    } else if (text[p] == ")" && (p in mate) && kind[before[mate[p]]] != "i" && (c = cast(mate[p])) != "") {
        kind_of = "init"; type = c; array = text[before[p]] == "]"
    } else if ((text[p] == "{" || text[p] == ",") && depth_now && block[depth_now] == "init") {
        kind_of = "init"; type = init_array[depth_now] ? init_type[depth_now] : ""
    } else if (text[p] == "(" || text[p] == "," || text[p] == "return") kind_of = "init"
    else if (kind[p] == "i") {
        for (q = p; q && text[q] !~ /^[;{}()=]$/ && text[q] !~ /^(struct|class|union|enum)$/; q = before[q]) { }
        if (text[q] ~ /^(struct|class|union)$/) {
            kind_of = "struct"
            if (kind[after[q]] == "i") own_type[text[after[q]]]
        } else if (text[q] == "enum") kind_of = "init"
        else if (struct_type(text[p]) && !(text[p] in own_type)) { kind_of = "init"; type = present(text[p]) }
        else if (p in type_of_token) { kind_of = "init"; type = variable(text[p]) }
    } else if (text[p] == "]" && cplusplus) kind_of = text[before[mate[p]]] ~ /^[=(,]$/ ? "block" : "init"
    outer_parens[++depth_now] = parens; parens = 0
    block[depth_now] = kind_of; init_type[depth_now] = type; init_array[depth_now] = array
    if (kind_of == "init" && (type in order) && !array) {
        for (q = after[i]; text[q] == "{"; q = after[q]) { }
        if (text[q] != "." && text[q] != "}" && !(text[q] == "0" && text[after[q]] == "}")) note(i, type, order[type])
    }
}
# token i, an identifier, as a field: what becomes of it
function field(i,    p, t, type, part, n, k, near) {
    t = text[i]
    if (!(t in is_field)) return
    p = before[i]
    if (text[p] == "." && text[before[p]] ~ /^[{,]$/ && !parens) {       # .field = in an initialiser
        if (block[depth_now] != "init") return
        type = init_type[depth_now]
        if (type == "" && depth_now) { unknown_field(i); return }
        near = after[i]
        if ((type, t) in to_field) {
            if (to_field[type, t] == "") note(i, t, to_said[type, t])
            else if (already(i, to_field[type, t]) || (index(to_field[type, t], t ".") == 1 && text[near] == "=" && \
                     text[after[near]] == "{")) return
            else if (cplusplus && index(to_field[type, t], "."))
                note(i, t, "In C++ write " nested(to_field[type, t]) " in place of ." t " = ....")
            else field_do[i] = to_field[type, t]
        }
        return
    }
    if (text[p] == "." || text[p] == "->") type = expression(before[p])
    else if (text[p] == "," && text[before[before[p]]] == "(" && text[before[before[before[p]]]] == "offsetof")
        type = present(text[before[p]])
    else return
    if (type == "") { unknown_field(i); return }
    if (!((type, t) in to_field)) return
    if (to_field[type, t] == "") note(i, t, to_said[type, t])
    else if (!already(i, to_field[type, t])) {
        field_do[i] = to_field[type, t]
        if (to_said[type, t] != "") note(i, t, to_said[type, t])
    }
}
function nested(path,    part, n, i, s) {
    n = split(path, part, ".")
    for (i = 1; i <= n; i++) s = s (i > 1 ? "{" : "") "." part[i] " = "
    s = s "..."
    for (i = 1; i < n; i++) s = s "}"
    return s
}
# whether the field that begins at token i is path already
function already(i, path,    part, n, k) {
    n = split(path, part, ".")
    if (n < 2 || part[1] != text[i]) return 0
    for (k = 2; k <= n; k++) {
        i = after[i]; if (text[i] != "." && text[i] != "->") return 0
        i = after[i]; if (text[i] != part[k]) return 0
    }
    return 1
}
# whether token i is the end of path already
function ends(i, path,    part, n, k) {
    n = split(path, part, ".")
    if (n < 2) return 0
    for (k = n; k >= 1; k--) {
        if (text[i] != part[k]) return 0
        i = before[before[i]]
    }
    return 1
}
function unknown_field(i,    part, n, k, to, t, said_one) {
    t = text[i]
    n = split(is_field[t], part, " ")
    for (k = 1; k <= n; k++) {
        to = to_field[present(part[k]), t]
        if (to != "" && (already(i, to) || ends(i, to))) return
        said_one = said_one (k > 1 ? " " : "") "If this is a field of " present(part[k]) ", " \
            (to != "" ? "write ." to "." : "then: " to_said[present(part[k]), t])
    }
    note(i, t, said_one)
}
function note(i, name, sentence) {
    if ((row[i], name) in noted) return
    noted[row[i], name]
    notes[++note_count] = row[i] ": " name ": " sentence
}

# --- rewriting

function rewrite(    i, last, out, name, used) {
    changes = 0
    out = ENVIRON["TO"] "/" file ".new"
    printf "" > out
    last = count
    if (index(" " ENVIRON["OPEN"] " ", " " file " ")) last--             # the last line does not end
    split("", told)
    for (i = 1; i <= last; i = next_token) printf "%s", emit(i, count) > out
    close(out)
    out = ENVIRON["TO"] "/" file ".notes"
    printf "" > out
    if (changes) for (i = first; i; i = after[i]) if (kind[i] == "i" && (text[i] in check) && !(text[i] in used)) {
        used[text[i]]; note(i, text[i], check[text[i]])
    }
    sort_notes()
    for (i = 1; i <= note_count; i++) print ARGV[file] ":" notes[i] > out
    close(out)
    out = ENVIRON["TO"] "/" file ".count"
    print changes + 0, note_count + 0 > out
    close(out)
}
function sort_notes(    i, k, s) {
    for (i = 2; i <= note_count; i++) {
        s = notes[i]
        for (k = i - 1; k >= 1 && notes[k] + 0 > s + 0; k--) notes[k + 1] = notes[k]
        notes[k + 1] = s
    }
}
# the present text of token i, or of the whole call that begins there; sets next_token behind it
function emit(i, to,    t, s, m) {
    t = text[i]; next_token = i + 1
    if (kind[i] == "c") return inside(t)
    if (kind[i] == "s") return substr(t, 1, 1) == "'" ? t : inside(t, 1)
    if (kind[i] != "i") return t
    if (i in field_do) { changes++; return field_do[i] }
    if (text[before[i]] == "." || text[before[i]] == "->") return t
    if (t in rows_of || t in fallback) {
        if (text[after[i]] == "(" && (after[i] in mate)) {
            m = mate[after[i]]
            if (m <= to && (s = call(i, m)) != "") { next_token = m + 1; changes++; return s }
            next_token = i + 1
            if (t in fallback) note(i, t, fallback[t])
        } else if (!(t in still)) note(i, t, t in fallback ? fallback[t] : "This function has other arguments now. Adapt its use here.")
    }
    if (t in gone) { note(i, t, gone[t]); return t }
    if (renamed(t)) {
        changes++
        if (said[t] != "" && !(t in told)) { told[t]; note(i, t, said[t]) }
        return new_name[t]
    }
    return t
}
function renamed(name) { return (name in new_name) && (only_with[name] == "" || only_with[name] in includes) }
# public names within a comment or a string. In a string a name that is part of the name of a file stays
function inside(s, is_string,    out, name, b, a) {
    if (s !~ /dem_|DEM_/) return s
    while (match(s, /[A-Za-z_\\][A-Za-z0-9_]*/)) {
        if (substr(s, RSTART, 1) == "\\") {                              # an escape, as \n
            out = out substr(s, 1, RSTART + 1); s = substr(s, RSTART + 2)
            continue
        }
        name = substr(s, RSTART, RLENGTH); b = RSTART > 1 ? substr(s, RSTART - 1, 1) : substr(out, length(out))
        a = substr(s, RSTART + RLENGTH, 2)
        out = out substr(s, 1, RSTART - 1); s = substr(s, RSTART + RLENGTH)
        if (name ~ /^(dem|DEM)_/ && renamed(name) && b !~ /[0-9]/ && !(is_string && file_name(b, a))) {
            changes++; out = out new_name[name]
        } else out = out name
    }
    return out s
}
function file_name(b, a) {
    return b != "" && index("/.-", b) || a ~ /^[.][A-Za-z0-9]/ || a ~ /^-/ || substr(a, 1, 1) == "/"
}
# the text of the call whose name is token i and whose last parenthesis is token m by the first row that fits, or ""
function call(i, m,    from, end, n, part, k, j, rows, got, lead, body, trail, p, q, r, bound) {
    n = 0; p = after[i]
    if (after[p] != m) {
        from[++n] = p + 1
        for (q = p + 1; q < m; q++) {
            if (kind[q] == "p" && (q in mate) && mate[q] > q) q = mate[q]
            else if (kind[q] == "p" && text[q] == ",") { end[n] = q - 1; from[++n] = q + 1 }
        }
        end[n] = m - 1
    }
    rows = split(rows_of[text[i]], part, " ")
    for (k = 1; k <= rows; k++) if (fits(part[k], n, from, end, got, bound)) break
    if (k > rows) return ""
    r = part[k]
    for (j = 1; j <= n; j++) {                                           # blanks and comments around the argument
        p = from[j]; q = end[j]; lead[j] = trail[j] = ""
        while (p <= q && !(p in before)) lead[j] = lead[j] emit(p++, m)
        while (q >= p && !(q in before)) trail[j] = emit(q--, m) trail[j]
        if (got[j] == "&") p = after[p]
        body[j] = ""
        for (; p <= q; p = next_token) body[j] = body[j] emit(p, q)
    }
    if (call_said[r] != "" && !((text[i], r) in told)) { told[text[i], r]; note(i, text[i], call_said[r]) }
    return filled(r, n, bound, lead, body, trail)
}
# whether the n arguments fit row r. bound[k] is the argument that is $k; got[j] is "&" if the row takes what follows
# the &
function fits(r, n, from, end, got, bound,    j, k, want, p, q, s, type) {
    split("", got); split("", bound)
    for (j = 1; j <= call_args[r]; j++) {
        want = call_arg[r, j]
        if (match(want, /\$[0-9]/)) bound[substr(want, RSTART + 1, 1)] = j
        if (want == "$*") return 1
        if (j > n) return 0
        for (p = from[j]; p <= end[j] && !(p in before); p++) { }
        for (q = end[j]; q >= p && !(q in before); q--) { }
        if (want ~ /^\$[0-9]$/) continue
        if (want ~ /^&\$[0-9]$/) {
            if (text[p] != "&" || p == q) return 0
            for (k = after[p]; k && k <= q; k = after[k]) {
                if ((k in mate) && mate[k] > k && k != after[p]) { k = mate[k]; continue }
                if (kind[k] != "i" && text[k] != "." && text[k] != "->") return 0
            }
            got[j] = "&"
        } else if (want ~ /^\$[0-9]:/) {
            type = present(substr(want, 4))
            if (argument(p, q) != type) return 0
        } else {
            s = ""
            for (k = p; k && k <= q; k = after[k]) s = s text[k]
            if (s != want) return 0
        }
    }
    return n == call_args[r]
}
# the type of the argument in tokens p to q
function argument(p, q) {
    while (text[p] == "&" || text[p] == "*") p = after[p]
    if (text[p] == "(" && (p in mate) && text[after[mate[p]]] == "{") return cast(p)
    if (kind[p] == "i" && text[after[p]] == "{" && struct_type(text[p])) return present(text[p])
    if (kind[p] == "i" && text[after[p]] == "(" && mate[after[p]] == q && (text[p] in returns))
        return known(returns[text[p]])
    return (q in seen_type) ? seen_type[q] : ""
}
function filled(r, n, bound, lead, body, trail,    s, out, j, k) {
    s = call_new[r]
    while (match(s, /\$[0-9*]/)) {
        out = out substr(s, 1, RSTART - 1); k = substr(s, RSTART + 1, 1); s = substr(s, RSTART + 2)
        if (k != "*") { out = put(out, bound[k], lead, body, trail); continue }
        for (j = call_args[r]; j <= n; j++) out = put(j > call_args[r] ? out ", " : out, j, lead, body, trail)
        if (n < call_args[r]) sub(/, $/, "", out)
    }
    return out s
}
function put(out, j, lead, body, trail,    l) {
    l = lead[j]
    if (substr(out, length(out)) == "(")
        return out (l ~ /[^ \t]/ ? l : "") body[j] (trail[j] ~ /[^ \t]/ ? trail[j] : "")
    if (l != "" && substr(out, length(out) - 1) == ", ") out = substr(out, 1, length(out) - 1) l
    else if (l ~ /[^ \t\r\n]/) out = out l
    return out body[j] (trail[j] ~ /[^ \t]/ ? trail[j] : "")
}
