# sh tests/web.sh DIR [PICTURES]: builds the browser lesson into DIR and looks whether it does what the native program
# does, see tests/web.mjs. What is not installed is skipped, loudly. Ends with "N passed, N failed", or SKIP.
sh examples/web/make.sh "$1"; code=$?
[ $code -eq 77 ] && exit 0
[ $code -eq 0 ] || { echo "0 passed, 1 failed"; exit 1; }
command -v node > /dev/null || { echo "SKIP: node not found (Debian package nodejs)"; exit 0; }
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[ -n "$browser" ] || echo "SKIP: no chromium to open the lesson in (Debian package chromium)"
node --no-warnings tests/web.mjs "$1" $browser $2
