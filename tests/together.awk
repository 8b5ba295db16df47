# awk -f tests/together.awk tests/test_a.c tests/test_b.c ... > build/tests.c: one program of many tests, so that
# dem.h is compiled once for all of them. What a test names at the left margin (functions, variables, types, enum
# constants) gets the test's name in front, by macros around its text; its own macros end with it; its main becomes
# TEST_main. The program runs the test named by its first argument, @NAME, with the rest of its arguments; without
# one, all of them.
FNR == 1 { file = FILENAME; test = file; sub(/.*\//, "", test); sub(/\.c$/, "", test); order[++tests] = test; path[test] = file }
function own(name) { if (name != "" && name != "main" && !((test, name) in seen)) { seen[test, name] = 1; names[test] = names[test] " " name } }
/^#define [A-Za-z_]/ { name = $2; sub(/\(.*/, "", name); macros[test] = macros[test] " " name; next }
/^static / {
    line = $0
    sub(/ = .*/, " =", line)
    if (match(line, /[A-Za-z_][A-Za-z_0-9]*\(/) && line !~ /^static [^(]*=/) own(substr(line, RSTART, RLENGTH - 1))
    else if (match(line, /[A-Za-z_][A-Za-z_0-9]*(\[[^]]*\])*( =|;)/)) { name = substr(line, RSTART, RLENGTH); sub(/[^A-Za-z_0-9].*/, "", name); own(name) }
}
/^typedef struct [a-z]/ { own($3) }
/^(typedef|struct|enum) .*\}? [a-z_0-9]+;/ || /^} [a-z_0-9]+;/ || /} [a-z_0-9]+;$/ && /^typedef/ { name = $NF; sub(/;/, "", name); if (name ~ /^[a-z]/) own(name) }
/^enum \{/ { enumerating = 1 }
enumerating {
    line = $0
    sub(/^enum \{/, "", line); sub(/\/\*.*/, "", line); ends = line ~ /\}/
    gsub(/[};]/, "", line); count = split(line, item, ",")
    for (k = 1; k <= count; k++) { name = item[k]; sub(/=.*/, "", name); gsub(/ /, "", name); own(name) }
    if (ends) enumerating = 0
}
END {
    print "/* made by tests/together.awk */\n#define DEM_IMPLEMENTATION\n#include \"dem.h\"\n#include \"tests/test.h\"\n#include \"tests/scene.h\""
    for (k = 1; k <= tests; k++) {
        test = order[k]
        count = split(names[test], item, " ")
        for (i = 1; i <= count; i++) print "#define " item[i] " " test "_" item[i]
        print "#define main " test "_main\n#include \"" path[test] "\"\n#undef main"
        for (i = 1; i <= count; i++) print "#undef " item[i]
        count = split(macros[test], item, " ")
        for (i = 1; i <= count; i++) if (item[i] !~ /^DEM_/) print "#undef " item[i]
    }
    print "typedef struct one { const char *name; int (*run)(int, char **); } one;\nstatic const one all[] = {"
    for (k = 1; k <= tests; k++) print "    {\"" order[k] "\", " order[k] "_main},"
    print "    {0, 0}};\nint main(int argc, char **argv) {\n    int bad = 0, k;"
    print "    const int named = argc > 1 && argv[1][0] == '@';"
    print "    for (k = 0; all[k].name; k++) {\n        char *word[] = {(char *)all[k].name, argc > 1 + named ? argv[1 + named] : 0, 0};"
    print "        if (named && strcmp(argv[1] + 1, all[k].name)) continue;"
    print "        memset(&test_now, 0, sizeof test_now);"
    print "        bad |= all[k].run(argc > 1 + named ? 2 : 1, word);\n    }\n    return bad;\n}"
}
