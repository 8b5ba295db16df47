# REPLAYS=build/write_replays sh tests/browser.sh: plays the replays of that program in a headless chromium. All frames
# must be read, a picture drawn, a grain coloured and a corner empty, and nothing written to the console. Ends with "N passed, N failed".
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[ -n "$browser" ] || { echo "SKIP: no chromium to play replays in (Debian package chromium)"; exit 0; }
dir=build/out/browser
mkdir -p $dir && "${REPLAYS:-build/write_replays}" $dir || exit 1
head -c $(($(wc -c < $dir/shapes.html)*2/3)) $dir/shapes.html > $dir/cut.html      # as a run that was killed leaves it
passed=0; failed=0
play() {                                       # NAME FRAMES GRAINS WALLS PLOTS
    cat $dir/$1.html tests/browser.html > $dir/$1_probe.html
    timeout 120 "$browser" --headless --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
        --window-size=1000,700 --virtual-time-budget=20000 --enable-logging=stderr --dump-dom \
        "file://$PWD/$dir/$1_probe.html?frames=$2&grains=$3&walls=$4&plots=$5" > $dir/$1.dom 2> $dir/$1.log
    said=$(sed -n 's/.*<title>\([^<]*\).*/\1/p' $dir/$1.dom | tail -n 1)
    console=$(grep -c 'CONSOLE' $dir/$1.log)
    if [ "${said#passed}" != "$said" ] && [ "$console" -eq 0 ]; then passed=$((passed + 1)); echo "ok    $1: $said"
    else failed=$((failed + 1)); echo "FAILED $1: $said; $console lines on the console, see $dir/$1.log"; fi
}
play shapes 40 141 2 2
play sieve 40 151 3 2
play cut some 141 2 2
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
