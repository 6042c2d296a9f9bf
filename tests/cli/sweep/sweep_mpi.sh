#!/usr/bin/env bash
# ctest-labels: slow
# Tests that a sweep on the ranks of mpirun gives the same bytes as a sweep on threads, also after a rank was killed.
set -u

program="$STOPLINE_BIN/stopline-sweep"
command -v mpirun >/dev/null || { echo "skipped: mpirun is not installed"; exit 77; }
ldd "$program" | grep -q libmpi || { echo "skipped: the program is built without MPI"; exit 77; }

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
sweep="$STOPLINE_SOURCE/scenarios/sweeps/single_light.yaml"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# mpirun creates its sockets in TMPDIR. Their path names must be short.
export TMPDIR=/tmp

# ranks COUNT FOLDER [OPTION...]: runs the sweep on COUNT ranks
ranks() {
    local count=$1 folder=$2
    shift 2
    timeout 120 mpirun --oversubscribe -n "$count" "$program" "$sweep" --output "$folder" "$@"
}

# same_results CASE FOLDER: expects the results of the sweep on threads in FOLDER
same_results() {
    for file in single_light.csv single_light.provenance.json; do
        cmp "$work/whole/$file" "$2/$file" || fail "$1: $file differs"
    done
}

"$program" "$sweep" --output "$work/whole" >/dev/null || fail "exit code $?"
for count in 1 2 3; do
    ranks $count "$work/ranks$count" >"$work/stdout" || fail "$count ranks: exit code $?"
    same_results "$count ranks" "$work/ranks$count"
    [ "$(grep -c "18 runs now" "$work/stdout")" -eq 1 ] || fail "$count ranks: $(cat "$work/stdout")"
done
grep -q "on 2 ranks" "$work/stdout" || fail "3 ranks: the number of working ranks is not 2: $(cat "$work/stdout")"
ranks 3 "$work/ranks3" >"$work/stdout" || fail "second call: exit code $?"
grep -q "were done before" "$work/stdout" || fail "second call: finished runs are repeated"

# An error is reported once, and all ranks end.
for options in "--set signal.gren=5" "--shard 5/4" "--nonsense"; do
    # shellcheck disable=SC2086 # two words
    ranks 3 "$work/bad" $options >"$work/stdout" 2>"$work/stderr"
    [ "$(grep -c "^stopline-sweep: " "$work/stderr")" -eq 1 ] || fail "$options: $(cat "$work/stderr")"
done
ranks 3 "$work/ranks3" --seed 2 >/dev/null 2>"$work/stderr" && fail "a changed seed is accepted"
grep -q "has changed since" "$work/stderr" || fail "changed seed: $(cat "$work/stderr")"

# kill_a_rank FOLDER: kills the last rank of a running sweep; this rank executes runs and does not own the store
kill_a_rank() {
    local victim=""
    for _ in $(seq 50); do
        victim=$(pgrep -n -f "^$program .*--output $1( |\$)") && [ -s "$1/single_light.sqlite-wal" ] && break
        sleep 0.1
    done
    sleep 0.5
    kill -KILL "$victim" || fail "there is no rank to kill"
}

# A rank is killed during the sweep. Finished runs are kept, and the same command continues.
"$program" "$sweep" --set "duration=2000 s" --output "$work/long" >/dev/null || fail "exit code $?"
ranks 3 "$work/killed" --set "duration=2000 s" >/dev/null 2>&1 &
mpi=$!
kill_a_rank "$work/killed"
wait $mpi && fail "the killed rank was not noticed"
ranks 3 "$work/killed" --set "duration=2000 s" >"$work/stdout" 2>"$work/stderr" || fail "after a rank died: $(cat "$work/stderr")"
cmp "$work/long/single_light.csv" "$work/killed/single_light.csv" || fail "after a rank died: the table differs"
now=$(sed -n 's/ runs now.*//p' "$work/stdout")
[ "${now:-18}" -lt 18 ] || fail "after a rank died: all runs are repeated"

# If mpirun leaves the other ranks alive, they also do the runs of the killed rank.
if mpirun --enable-recovery -n 1 true 2>/dev/null; then
    timeout 120 mpirun --enable-recovery --oversubscribe -n 3 "$program" "$sweep" --set "duration=2000 s" \
        --rank-timeout "3 s" --output "$work/recovered" >/dev/null 2>"$work/stderr" &
    mpi=$!
    kill_a_rank "$work/recovered"
    wait $mpi || fail "with recovery: exit code $?: $(cat "$work/stderr")"
    grep -q "1 of 3 ranks died" "$work/stderr" || fail "with recovery: the killed rank is not reported"
    cmp "$work/long/single_light.csv" "$work/recovered/single_light.csv" || fail "with recovery: the table differs"
fi

exit $((failures > 0))
