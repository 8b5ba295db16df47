# awk -f tests/hard/totals.awk build/hard.log: what all programs of `make hard` counted, as lines "name = value".
/^impacts = [0-9]+$/ { impacts += $3 }
/^impacts_gaining = [0-9]+$/ { gaining += $3 }
/^(hard|test)_[a-z]+: [0-9]+ passed, [0-9]+ failed$/ { stable += $2; cases += $2 + $4 }
END {
    printf "impacts = %d\nimpacts_gaining = %d\ncases = %d\ncases_stable = %d\n", impacts, gaining, cases, stable
}
