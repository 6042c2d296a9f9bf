#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 600
# The paper in one command, on its smallest section: exit codes, the same bytes after a kill and with other threads, one job that
# fails while the rest goes on, and a page that is valid HTML.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-reproduce"
command -v gnuplot >/dev/null || exit 77

# report FOLDER [OPTION...]: Section III, reduced
report() {
    local folder=$1
    shift
    "$program" --section III --quick --output "$folder" "$@"
}

# The report of a folder: the page, figures and tables, by name and content; not how long jobs took.
bytes_of() {
    (cd "$1" && find index.html figures tables -type f | LC_ALL=C sort | xargs sha256sum)
}

report "$work/whole" >"$work/stdout" 2>"$work/stderr" || fail "exit code $?: $(cat "$work/stderr")"
grep -q "rows of the paper" "$work/stdout" || fail "no counts in: $(cat "$work/stdout")"
grep -q "file://$work/whole/index.html" "$work/stdout" || fail "nowhere to click: $(cat "$work/stdout")"
grep -q " 0 open" "$work/stdout" || fail "rows are open: $(cat "$work/stdout")"
bytes_of "$work/whole" >"$work/expected"
for name in index.html figures/fig05_counters.svg figures/fig05_counters.png tables/scorecard.csv tables/single_light_summary.csv; do
    [ -s "$work/whole/$name" ] || fail "no $name"
done
grep -q "REDUCED" "$work/whole/figures/fig05_counters.svg" || fail "a figure does not say that it is reduced"
grep -q "REDUCED" "$work/whole/index.html" || fail "the page does not say that it is reduced"
grep -qE '(src|href)="https?:' "$work/whole/index.html" && fail "the page loads something from elsewhere"

python=python3
"$python" -c "import html5lib" 2>/dev/null || python=/usr/bin/python3  # where Debian's packages are
if "$python" -c "import html5lib" 2>/dev/null; then
    "$python" "$STOPLINE_SOURCE/tests/tools/check_html.py" "$work/whole/index.html" || fail "the page is not valid"
    sed 's|</table>||' "$work/whole/index.html" >"$work/whole/broken.html"
    "$python" "$STOPLINE_SOURCE/tests/tools/check_html.py" "$work/whole/broken.html" >/dev/null &&
        fail "the check of pages finds nothing"
    rm "$work/whole/broken.html"
fi

same_report() {
    bytes_of "$2" | cmp - "$work/expected" || fail "$1: another report"
}

# Nothing is done again; the page has the same bytes.
report "$work/whole" --threads 1 >"$work/stdout" || fail "again: exit code $?"
[ "$(grep -c "done before" "$work/stdout")" -eq 2 ] || fail "again: jobs are done again: $(cat "$work/stdout")"
same_report "again" "$work/whole"
report "$work/one" --threads 1 >/dev/null || fail "one thread: exit code $?"
same_report "one thread" "$work/one"

# What is not as it was is made again.
echo >"$work/whole/runs_reduced/startup/startup.svg"
report "$work/whole" >"$work/stdout" || fail "damaged: exit code $?"
[ "$(grep -c "done before" "$work/stdout")" -eq 1 ] || fail "damaged: $(cat "$work/stdout")"
same_report "damaged" "$work/whole"

# Killed after random times, and started again.
for ms in 50 200 400 800 1200 1600; do
    "$program" --section III --quick --output "$work/killed" >/dev/null 2>&1 &
    pid=$!
    sleep "$(printf '%d.%03d' $((ms / 1000)) $((ms % 1000)))"
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
done
mkdir -p "$work/killed/figures" "$work/killed/runs_reduced/startup"
sleep 0 &
wait $!  # its number is nobody's now
touch "$work/killed/figures/.fig05_counters.svg.$!.part" "$work/killed/runs_reduced/startup/.startup.csv.$!.part"
report "$work/killed" >/dev/null || fail "after kills: exit code $?"
find "$work/killed" -name '.*.part' | grep -q . && fail "parts of files of killed programs stay: $(find "$work/killed" -name '.*.part')"
same_report "after kills" "$work/killed"

# A kill in the middle of a sweep: finished runs are not lost.
"$program" --section IV --quick --threads 1 --output "$work/sweep" >"$work/stdout" 2>&1 &
pid=$!
wait_for [ -s "$work/sweep/runs_reduced/stores/measured/bands_full.sqlite-wal" ] || fail "no store"
kill -KILL $pid
wait $pid 2>/dev/null
grep -q "IV " "$work/stdout" || fail "jobs that ended are not said: $(cat "$work/stdout")"

# Ctrl-C.
code=0
timeout --preserve-status --signal=INT 1 "$program" --section IV --output "$work/stopped" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 130 ] || fail "Ctrl-C: exit code $code: $(cat "$work/stderr")"
[ -e "$work/stopped/index.html" ] && fail "Ctrl-C: a page of runs that did not end"

# refused WHAT PART OPTION...: exit code 2, PART in the message
refused() {
    local what=$1 part=$2
    shift 2
    local code=0
    PATH="$search" "$program" "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$what: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$what: no '$part' in: $(cat "$work/stderr")"
}
search=$PATH
touch "$work/file"
refused "unknown section" "allowed: III, IV, V, VI, VII, all" --section VIII --output "$work/none"
[ -e "$work/none" ] && fail "a folder for a section that there is not"
refused "no folder" "cannot create the folder" --section III --output "$work/file/sub"
refused "no threads" "--threads" --threads 0
search=/nowhere
refused "no gnuplot" "install the Debian package gnuplot-nox" --section III --output "$work/no_gnuplot"

# A job that fails costs only itself: the rest is there, the page says what is missing, and the exit code is 1.
mkdir "$work/project"
cp -r "$STOPLINE_SOURCE/data" "$STOPLINE_SOURCE/scenarios" "$work/project"
echo "t_s,mean_kmh" >"$work/project/data/startup/kit_curve_leader50.csv"
code=0
STOPLINE_DATA="$work/project/data" report "$work/failed" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 1 ] || fail "a failing job: exit code $code: $(cat "$work/stderr")"
grep -q "failed: start of a platoon leader" "$work/stderr" || fail "a failing job is not said: $(cat "$work/stderr")"
grep -q "Missing: the runs failed" "$work/failed/index.html" || fail "the page hides what failed"
[ -s "$work/failed/figures/fig05_counters.svg" ] || fail "one failing job takes others with it"
[ -e "$work/failed/figures/fig02_startup.svg" ] && fail "a figure of a job that failed"

exit $((failures > 0))
