# TEST_NUMBERS=1 make test | awk -f tests/validation.awk > build/validation.csv: one line per test, with the number that came
# nearest to its tolerance. docs/data/validation.csv is made of these.
BEGIN {
    print "# TEST_NUMBERS=1 make test | awk -f tests/validation.awk; double precision, gcc 12 -O2"
    print "program,case,number,measured,expected,tolerance,tolerance used [%]"
}
/^\| .* \| `.*` \| [^|]* \| [^|]* \| [^|]* \| [0-9]+ % \|$/ {
    line = substr($0, 3)
    split_at = index(line, " | `")
    name = substr(line, 1, split_at - 1); line = substr(line, split_at + 4)
    match(line, /` \| [^|`]* \| [^|`]* \| [^|`]* \| [0-9]+ % \|$/)
    number = substr(line, 1, RSTART - 1); line = substr(line, RSTART + 4)
    split(line, value, / \| | % \|$/)
    gsub(/"/, "\"\"", name); gsub(/"/, "\"\"", number)
    row[++rows] = "\"" name "\",\"" number "\"," value[1] "," value[2] "," value[3] "," value[4]
    next
}
/^[a-z]+_[a-z_]+: [0-9]+ passed, [0-9]+ failed$/ {
    sub(/:.*/, "")
    for (i = 1; i <= rows; i++) print $0 "," row[i]
    rows = 0
}
