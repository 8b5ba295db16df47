# awk -f tests/libm.awk dem.h: the implementation calls no function of libm that C libraries round each in their own way
# (>>maths has dem.h's own): otherwise runs on two systems would not have the same bits.
/^#if defined\(DEM_IMPLEMENTATION\)/ { on = 1 }
/viewer: begin/ { on = 0 }
/viewer: end/ { on = 1 }
on {
    line = $0
    gsub(/"([^"\\]|\\.)*"/, "", line)
    code = ""
    while (line != "") {
        at = index(line, comment ? "*/" : "/*")
        if (!comment) code = code (at ? substr(line, 1, at - 1) : line)
        if (!at) break
        line = substr(line, at + 2)
        comment = !comment
    }
    if ((" " code) ~ /[^A-Za-z0-9_.>](sin|cos|tan|exp|exp2|log|log2|log10|pow|cbrt|hypot|atan|atan2|acos|asin|sinh|cosh|tanh)\(/) {
        print FILENAME ": line " FNR ": calls a function of libm that libraries round in their own way: " $0
        bad = 1
    }
}
END { if (!on) { print FILENAME ": no implementation found"; bad = 1 } exit bad }
