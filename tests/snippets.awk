# awk -v out=DIR -f tests/snippets.awk dem.h page.md...: takes the C blocks out of the pages (between
# ```c and ```) and the program out of dem.h's manual, and writes each to DIR/FILE_N_program.c when it
# has a main, to DIR/FILE_N_part.c otherwise (with dem.h included before it). A block whose first line is
# /* NAME.h */ is written to DIR/NAME.h too, for programs that include it.
# In pages whose name contains how_to the first block of the first page is a complete program. What it has in
# front of main is the frame, DIR/how_to.h, of all other blocks: bodies of a main, or functions (blocks that
# begin with static) in front of the next main. A ```text block behind one is what the program prints:
# DIR/FILE_N_program.expected; ```text varies: other figures on other machines.
FNR == 1 { name = FILENAME; sub(/.*\//, "", name); gsub(/[^A-Za-z0-9]/, "_", name); n = 0; inside = manual = 0 }
FILENAME ~ /\.md$/ && /^```c$/ { inside = 1; text = ""; start = FNR; next }
FILENAME ~ /how_to/ && /^```text/ { printed = out "/" name "_" n "_program.expected"; print ($2 == "" ? "same" : $2) > printed; next }
printed != "" { if (/^```/) { close(printed); printed = "" } else print > printed; next }
FILENAME ~ /\.md$/ && /^```/ && inside { finish(); next }
FILENAME ~ /\.h$/ && $1 == ">>manual" { manual++ }
FILENAME ~ /\.h$/ && manual == 2 && /^ +#define DEM_IMPLEMENTATION/ && n == 0 {
    inside = 1; text = ""; start = FNR; match($0, /^ +/); indent = RLENGTH
}
inside {
    text = text (FILENAME ~ /\.h$/ ? substr($0, indent + 1) : $0) "\n"
    if (FILENAME ~ /\.h$/ && substr($0, indent + 1) == "}") finish()
}
function finish(    program, file) {
    inside = 0
    program = text ~ /int main\(/
    if (FILENAME ~ /how_to/ && !program) { recipe(); return }
    if (FILENAME ~ /how_to/) { printf "%s", substr(text, 1, index(text, "int main(") - 1) > (out "/how_to.h"); close(out "/how_to.h") }
    file = out "/" name "_" ++n (program ? "_program.c" : "_part.c")
    if (text !~ /#include "dem.h"/) print "#include \"dem.h\"" > file
    printf "#line %d \"%s\"\n%s", start + (FILENAME ~ /\.md$/), FILENAME, text > file
    close(file)
    if (match(text, /^\/\* [a-z_]+\.h \*\//)) {
        file = out "/" substr(text, 4, RLENGTH - 6)
        printf "%s", text > file
        close(file)
    }
}
function recipe(    file) {
    text = sprintf("#line %d \"%s\"\n%s", start + 1, FILENAME, text)
    if (text ~ /\nstatic /) { functions = functions text; return }
    file = out "/" name "_" ++n "_program.c"
    printf "#include \"how_to.h\"\n%sint main(void) {\ndem_world_desc desc = DEM_WORLD_DESC;\n", functions > file
    printf "desc.gravity.z = -9.81;\n%sdem_world_destroy(world);\nreturn 0;\n}\n", text > file
    close(file)
    functions = ""
}
END { if (inside) { print FILENAME ": a C block does not end"; exit 1 } }
