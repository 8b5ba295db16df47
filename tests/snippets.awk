# awk -v out=DIR -f tests/snippets.awk dem.h page.md...: takes the C blocks out of the pages (between
# ```c and ```) and the program out of dem.h's manual, and writes each to DIR/FILE_N_program.c when it
# has a main, to DIR/FILE_N_part.c otherwise (with dem.h included before it). A block whose first line is
# /* NAME.h */ is written to DIR/NAME.h too, for programs that include it.
# In pages whose name contains how_to a block is the body of a main; blocks that begin with static are
# functions in front of the next main. The frame is the block /* how_to.h */ of the first of these pages.
FNR == 1 { name = FILENAME; sub(/.*\//, "", name); gsub(/[^A-Za-z0-9]/, "_", name); n = 0; inside = manual = 0 }
FILENAME ~ /\.md$/ && /^```c$/ { inside = 1; text = ""; start = FNR; next }
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
    if (FILENAME ~ /how_to/ && text !~ /^\/\* how_to/) { recipe(); return }
    program = text ~ /int main\(/
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
