# Builds every tests/fuzz_NAME.c with clang's fuzzer and sanitizers and lets it run for FUZZ_SECONDS.
# Seeds come from tests/corpus/NAME and stay as they are; what the fuzzer finds goes to build/corpus/NAME,
# an input that breaks one to build/fuzz_NAME-*.
cc=${FUZZ_CC:-clang}; seconds=${FUZZ_SECONDS:-600}
command -v "$cc" >/dev/null || { echo "SKIP: $cc not found (Debian package clang)"; exit 0; }
mkdir -p build
failed=
for source in tests/fuzz_*.c; do
    [ -f "$source" ] || { echo "SKIP: there is no tests/fuzz_*.c"; exit 0; }
    name=$(basename "$source" .c); corpus=${name#fuzz_}
    echo "== $name: $seconds s"
    $cc -g -O1 -I. -fsanitize=fuzzer,address,undefined,float-cast-overflow -fno-sanitize-recover=all \
        "$source" -o "build/$name" -lm || { failed="$failed $name"; continue; }
    mkdir -p "build/corpus/$corpus"
    seeds=; [ -d "tests/corpus/$corpus" ] && seeds="tests/corpus/$corpus"
    "build/$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
        -artifact_prefix="build/$name-" -print_final_stats=1 -verbosity=0 \
        "build/corpus/$corpus" $seeds || failed="$failed $name"
done
[ -z "$failed" ] && echo "all survived" || { echo "fuzz failed:$failed"; exit 1; }
