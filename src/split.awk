# awk -v to=src -f src/split.awk src/dem.h dem.h: the reverse of join.awk, for changes that somebody made in dem.h itself.
# Writes every room that differs, and src/dem.h, into the folder `to`. A room begins with the rule above its banner's
# >>tag. It ends where the next room or the next line of src/dem.h begins.
NR == FNR { frame[++frames] = $0; next }
{ text[++lines] = $0 }
END {
    for (i = 1; i <= frames; i++) {
        if (frame[i] !~ /^#include "/) continue
        split(frame[i], part, "\""); name = part[2]
        sub(/\.h$/, "", name); sub(/.*\//, "", name)
        for (n = 1; n < lines && !(text[n] ~ /^\/\* (-----|=====)/ && text[n + 1] == "   >>" name); n++) ;
        if (n == lines) { print "src/split.awk: dem.h has no part >>" name > "/dev/stderr"; exit 1 }
        begins[i] = n
        path[i] = part[2]
    }
    at = 1
    for (i = 1; i <= frames; i++) {
        if (!(i in begins)) {
            if (text[at] == "" && frame[i] != "" && gap) at++
            gap = 0
            outer = outer text[at++] "\n"
            continue
        }
        at = begins[i]
        for (next_line = i + 1; next_line <= frames && frame[next_line] == ""; next_line++) ;
        room = ""; blank = ""
        for (; at <= lines; at++) {
            if (next_line in begins ? at == begins[next_line] : next_line <= frames && text[at] == frame[next_line]) break
            if (text[at] == "") blank = blank "\n"
            else { room = room blank text[at] "\n"; blank = "" }
        }
        outer = outer frame[i] "\n"
        gap = 1
        write(to "/" path[i], room)
    }
    write(to "/dem.h", outer)
}
function write(file, new,   old, line) {
    while ((getline line < file) > 0) old = old line "\n"
    close(file)
    if (old == new) return
    printf "%s", new > file
    close(file)
    print file
}
