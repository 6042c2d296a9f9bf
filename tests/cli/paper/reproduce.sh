#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 600
# Tests stopline-reproduce on the smallest section of the paper: exit codes, equal bytes after a kill and for any number
# of threads, a failing job that does not stop the others, and valid HTML.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-reproduce"
command -v gnuplot >/dev/null || exit 77

# report FOLDER [OPTION...]: writes the reduced report of Section III
report() {
    local folder=$1
    shift
    "$program" --section III --quick --output "$folder" "$@"
}

# bytes_of FOLDER: prints names and hashes of the page, the figures and the tables of a report, without the job times
bytes_of() {
    (cd "$1" && find index.html figures tables -type f | LC_ALL=C sort | xargs sha256sum)
}

report "$work/whole" >"$work/stdout" 2>"$work/stderr" || fail "exit code $?: $(cat "$work/stderr")"
grep -q "rows with results" "$work/stdout" || fail "the number of rows is missing in: $(cat "$work/stdout")"
grep -q "file://$work/whole/index.html" "$work/stdout" || fail "the link to the page is missing in: $(cat "$work/stdout")"
grep -q " 0 open" "$work/stdout" || fail "open rows remain: $(cat "$work/stdout")"
bytes_of "$work/whole" >"$work/expected"
for name in index.html figures/fig05_counters.svg figures/fig05_counters.png tables/scorecard.csv tables/single_light_summary.csv; do
    [ -s "$work/whole/$name" ] || fail "$name is missing or empty"
done
grep -q "REDUCED" "$work/whole/figures/fig05_counters.svg" || fail "the figure is not marked as REDUCED"
grep -q "REDUCED" "$work/whole/index.html" || fail "the page is not marked as REDUCED"
grep -qE '(src|href)="https?:' "$work/whole/index.html" && fail "the page loads files from the network"

python=python3
"$python" -c "import html5lib" 2>/dev/null || python=/usr/bin/python3  # the interpreter with Debian's packages
if "$python" -c "import html5lib" 2>/dev/null; then
    "$python" "$STOPLINE_SOURCE/tests/tools/check_html.py" "$work/whole/index.html" || fail "the page is not valid HTML"
    sed 's|</table>||' "$work/whole/index.html" >"$work/whole/broken.html"
    "$python" "$STOPLINE_SOURCE/tests/tools/check_html.py" "$work/whole/broken.html" >/dev/null &&
        fail "check_html.py accepts a broken page"
    rm "$work/whole/broken.html"
fi

# same_report CASE FOLDER: expects the same report in FOLDER as in the first run
same_report() {
    bytes_of "$2" | cmp - "$work/expected" || fail "$1: the report differs"
}

# A second call with the same folder repeats no job, and its page has the same bytes.
report "$work/whole" --threads 1 >"$work/stdout" || fail "again: exit code $?"
[ "$(grep -c "done before" "$work/stdout")" -eq 2 ] || fail "again: jobs were repeated: $(cat "$work/stdout")"
same_report "again" "$work/whole"
report "$work/one" --threads 1 >/dev/null || fail "one thread: exit code $?"
same_report "one thread" "$work/one"

# A damaged result is computed again.
echo >"$work/whole/runs_reduced/startup/startup.svg"
report "$work/whole" >"$work/stdout" || fail "damaged: exit code $?"
[ "$(grep -c "done before" "$work/stdout")" -eq 1 ] || fail "damaged: $(cat "$work/stdout")"
same_report "damaged" "$work/whole"

# Several kills at different times, each followed by a restart.
for ms in 50 200 400 800 1200 1600; do
    "$program" --section III --quick --output "$work/killed" >/dev/null 2>&1 &
    pid=$!
    sleep "$(printf '%d.%03d' $((ms / 1000)) $((ms % 1000)))"
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
done
mkdir -p "$work/killed/figures" "$work/killed/runs_reduced/startup"
# The name of a partial file contains a number of the machine and the number of the process that writes the file. The
# two files below have the number ($!) of a process that has already ended. The next run must remove both files.
sleep 0 &
wait $!
part=$(machine_number).$!.part
touch "$work/killed/figures/.fig05_counters.svg.$part" "$work/killed/runs_reduced/startup/.startup.csv.$part"
report "$work/killed" >/dev/null || fail "after kills: exit code $?"
find "$work/killed" -name '.*.part' | grep -q . && fail "partial files of killed programs are left: $(find "$work/killed" -name '.*.part')"
same_report "after kills" "$work/killed"

# A kill in the middle of a sweep. Finished runs are kept.
"$program" --section IV --quick --threads 1 --output "$work/sweep" >"$work/stdout" 2>&1 &
pid=$!
wait_for [ -s "$work/sweep/runs_reduced/stores/measured/bands_full.sqlite-wal" ] || fail "there is no store of runs"
kill -KILL $pid
wait $pid 2>/dev/null
grep -q "IV " "$work/stdout" || fail "finished jobs are not reported: $(cat "$work/stdout")"

# Ctrl-C.
code=0
timeout --preserve-status --signal=INT 1 "$program" --section IV --output "$work/stopped" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 130 ] || fail "Ctrl-C: exit code $code: $(cat "$work/stderr")"
[ -e "$work/stopped/index.html" ] && fail "Ctrl-C: there is a page of unfinished runs"

# refused CASE PART OPTION...: expects exit code 2 and PART in the message
refused() {
    local case_name=$1 part=$2
    shift 2
    local code=0
    PATH="$search" "$program" "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$case_name: '$part' is missing in: $(cat "$work/stderr")"
}
search=$PATH
touch "$work/file"
refused "unknown section" "allowed: III, IV, V, VI, VII, coordination, energy, all" --section VIII --output "$work/none"
[ -e "$work/none" ] && fail "there is a folder for an unknown section"
refused "no folder" "cannot create the folder" --section III --output "$work/file/sub"
refused "no threads" "--threads" --threads 0
mkdir "$work/alone"
cp -r "$STOPLINE_SOURCE/data" "$work/alone"
STOPLINE_DATA="$work/alone/data" refused "no scenarios" "there is no folder $work/alone/scenarios" --section III --output "$work/none"
search=/nowhere
refused "no gnuplot" "install the Debian package gnuplot-nox" --section III --output "$work/no_gnuplot"

# A failing job does not stop the other jobs. The page names the missing figure, and the exit code is 1.
mkdir "$work/project"
cp -r "$STOPLINE_SOURCE/data" "$STOPLINE_SOURCE/scenarios" "$work/project"
echo "t_s,mean_kmh" >"$work/project/data/startup/kit_curve_leader50.csv"
code=0
STOPLINE_DATA="$work/project/data" report "$work/failed" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 1 ] || fail "a failing job: exit code $code: $(cat "$work/stderr")"
grep -q "failed: start of a platoon leader" "$work/stderr" || fail "the failing job is not reported: $(cat "$work/stderr")"
grep -q "Missing: the runs failed" "$work/failed/index.html" || fail "the page does not name the missing figure"
[ -s "$work/failed/figures/fig05_counters.svg" ] || fail "a failing job stops other jobs"
[ -e "$work/failed/figures/fig02_startup.svg" ] && fail "there is a figure of the failing job"

exit $((failures > 0))
