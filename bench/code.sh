# sh bench/code.sh: the rows of bench/figures.txt with the code as it is now: PAGE|BLOCK|COMMAND|PARTS|DIGESTS, a digest for
# each part, in their order: the last six digits of its checksum (cksum), without comments and white space; 0 if it is missing.
export LC_ALL=C
dir=build/code
rm -rf $dir; mkdir -p $dir/parts
# sets are put in place of their names
awk -F ' *[|] *' '
    /^#/ || /^ *$/ { next }
    NF == 4 { print $1 "|" $2 "|" $3 "|" expand($4); next }
    / = / { name = $1; sub(/ = .*/, "", name); list = $1; sub(/^[^=]*= */, "", list); set[name] = expand(list); next }
    { print "bench/figures.txt:" FNR ": a row has four columns, a set is NAME = PARTS" | "cat 1>&2"; exit 1 }
    function expand(list,   n, i, part, all) {
        n = split(list, part, / *, */)
        for (i = 1; i <= n; i++) all = all (i > 1 ? "," : "") (part[i] in set ? set[part[i]] : part[i])
        return all
    }' bench/figures.txt > $dir/rows || exit 1
files=$(cut -d '|' -f 4 $dir/rows | tr ',' '\n' | sort -u | while read -r f; do [ -f "$f" ] && [ "$f" != dem.h ] && echo "$f"; done)
awk -v out=$dir/parts -f bench/code.awk dem.h $files || exit 1
cat $dir/parts/'>>'* > $dir/parts/dem.h
(cd $dir/parts && cksum ./*) | awk '
    NR == FNR { name = $3; sub(/^\.\//, "", name); gsub(/%/, "/", name); digest[name] = $1%1000000; next }
    { n = split($4, part, ","); all = ""
      for (i = 1; i <= n; i++) all = all (i > 1 ? "," : "") (part[i] in digest ? digest[part[i]] : 0)
      print $0 "|" all }' - FS='|' $dir/rows
