#!/usr/bin/env bash
# ctest-labels: slow
# Tests that a damaged store never gives a wrong table. A store that is cut or has a changed byte either gives the same
# table as before, or a message that names the file and exit code 2.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-sweep"
sed 's/^duration: .*/duration: 100 s/' "$STOPLINE_SOURCE/scenarios/first_steps.yaml" >"$work/short.yaml"
cat >"$work/sweep.yaml" <<'YAML'
scenario: short.yaml
axes:
- {name: hesitation, path: driver.free_drive.hesitation, values: [0 s, 0.5 s, 1 s]}
repetitions: 3
YAML

# Without gnuplot in PATH, the program draws no figures, which would take most of the time.
"$program" "$work/sweep.yaml" --output "$work/good" >/dev/null || fail "exit code $?"
store="$work/good/sweep.sqlite"
size=$(stat -c %s "$store")

# damage KIND NUMBER: writes a damaged copy of the store to $work/bad/sweep.sqlite
damage() {
    rm -rf "$work/bad"
    mkdir "$work/bad"
    python3 - "$store" "$work/bad/sweep.sqlite" "$@" <<'PYTHON'
import random, sys
source, target, kind, number = sys.argv[1:]
data = bytearray(open(source, "rb").read())
draw = random.Random(f"{kind} {number}")
if kind == "cut":
    data = data[:1 + draw.randrange(len(data) - 1)]
elif kind == "flip":
    data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
else:  # a byte of a stored result; most other bytes of the small store are not used
    places = [k for k in range(len(data) - 5) if data[k:k + 5] == b"seed="]
    data[draw.choice(places) + 6 + draw.randrange(200)] ^= 1 << draw.randrange(8)
open(target, "wb").write(data)
PYTHON
}

# check CASE: continues the sweep with the damaged store
check() {
    local code=0
    PATH=/nonexistent "$program" "$work/sweep.yaml" --output "$work/bad" >"$work/stdout" 2>"$work/stderr" || code=$?
    if [ $code -eq 0 ]; then
        same=$((same + 1))
        cmp "$work/good/sweep.csv" "$work/bad/sweep.csv" || fail "$1: a wrong table with exit code 0"
    else
        refused=$((refused + 1))
        [ $code -eq 2 ] || fail "$1: exit code $code: $(cat "$work/stderr")"
        grep -qF "$work/bad/sweep.sqlite: " "$work/stderr" || fail "$1: the message does not name the store: $(cat "$work/stderr")"
        [ -e "$work/bad/sweep.csv" ] && fail "$1: there is a table"
    fi
}

for kind in cut flip result; do
    same=0
    refused=0
    for number in $(seq 60); do
        damage $kind "$number"
        check "$kind $number"
    done
    echo "$kind of $size bytes: $same times the same table, $refused times refused"
done
[ "$refused" -eq 60 ] || fail "a changed result was accepted $same times"
grep -qE "damaged: .*Remove the file and repeat the sweep that wrote it" "$work/stderr" || fail "no advice: $(cat "$work/stderr")"

# A damaged part of a sweep is not joined.
code=0
"$program" merge --output "$work/joined" "$work/bad/sweep.sqlite" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 2 ] || fail "merge of a damaged store: exit code $code"

# A store of an earlier version of the program, which had no checksums.
rm -rf "$work/old"
mkdir "$work/old"
python3 - "$work/old/sweep.sqlite" <<'PYTHON'
import sqlite3, sys
store = sqlite3.connect(sys.argv[1])
store.execute("CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID")
store.execute("CREATE TABLE runs(point INTEGER PRIMARY KEY, result TEXT NOT NULL)")
store.execute("INSERT INTO meta VALUES('format', 'stopline runs 1')")
store.commit()
PYTHON
code=0
"$program" "$work/sweep.yaml" --output "$work/old" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 2 ] || fail "store of another version: exit code $code"
grep -qF "$work/old/sweep.sqlite: another version of the program wrote this store" "$work/stderr" ||
    fail "store of another version: $(cat "$work/stderr")"

exit $((failures > 0))
