# sh tests/pages.sh: says for each block of figures in README.md and docs, and for each table in docs/data, whether the code
# that it depends on has changed since it was measured. Needs no history: a stamp holds checksums of the code. STRICT=1:
# figures that are older than their code are an error, too.
mkdir -p build
sh bench/code.sh > build/code.now || exit 1
awk -v strict="${STRICT:-0}" -f tests/pages.awk build/code.now README.md docs/*.md docs/data/*.csv
