# awk -f src/join.awk src/dem.h: prints dem.h: src/dem.h with every room that it includes ("folder/room.h") in its
# place, between blank lines.
/^#include "/ {
    split($0, name, "\"")
    path = FILENAME; sub(/[^\/]*$/, name[2], path)
    if (last != "") print ""
    lines = 0
    while ((got = (getline line < path)) > 0) { print line; lines++ }
    close(path)
    if (!lines) { print "src/join.awk: " path ": not found or empty" > "/dev/stderr"; exit bad = 1 }
    if (line == "") { print "src/join.awk: " path ": ends with a blank line" > "/dev/stderr"; exit bad = 1 }
    last = "room"
    next
}
{ if (last == "room" && $0 != "") print ""; print; last = $0 }
