#!/usr/bin/env bash
# Every column of every table that runs and sweeps write is explained in scenarios/README.md, 'Columns of results', under the
# heading of its file: small runs of each kind of network, and a sweep of each.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
glossary="$STOPLINE_SOURCE/scenarios/README.md"

# columns_under HEADING: the names in the first cells of the table there, as patterns: words in capitals stand for what differs
columns_under() {
    # shellcheck disable=SC2016 # the backticks are those of the tables
    awk -v heading="### $1" '/^##/ { under = $0 == heading; next } under && /^\| `/ { split($0, cells, "|"); print cells[2] }' \
        "$glossary" | grep -o '`[^`]*`' | tr -d '`' | sed -E 's/[A-Z]+/[A-Za-z0-9_.-]+/g'
}

# expect_explained FILE HEADING [AXIS...]: each column, but for those of a sweep's own axes
expect_explained() {
    local file=$1 heading=$2 column
    shift 2
    [ -s "$file" ] || { fail "$heading: no file $file"; return; }
    columns_under "$heading" >"$work/known"
    [ -s "$work/known" ] || { fail "no table of columns under '### $heading' in $glossary"; return; }
    printf '%s\n' "$@" >>"$work/known"
    head -n 1 "$file" | tr ',' '\n' >"$work/columns"
    while read -r column; do
        grep -qxE -f "$work/known" <<<"$column" || fail "the column '$column' of $(basename "$file") is not under '### $heading' in $glossary"
    done <"$work/columns"
}

# expect_all_explained FOLDER KIND: each table in it
expect_all_explained() {
    local file tables=0
    for file in "$work/$1"/*.csv; do
        expect_explained "$file" "$2: $(basename "$file")"
        tables=$((tables + 1))
    done
    [ $tables -ge "$3" ] || fail "$1: $tables tables instead of $3 or more"
}

# run FOLDER SCENARIO [OPTION...]
run() {
    local folder=$1 scenario=$2
    shift 2
    "$STOPLINE_BIN/stopline-run" "$scenario" --no-figures --output "$work/$folder" "$@" >"$work/stdout" 2>"$work/stderr" ||
        fail "$folder: exit code $?: $(tail -n 3 "$work/stderr")"
}

brief=(--set 'populations=[CDG]' --set measure.baseline=CDG --trajectories --interval "10 s")
network=("${brief[@]}" --set "duration=130 s" --set "measure.steady=60 s")
run grid "$STOPLINE_SOURCE/scenarios/grid.yaml" "${network[@]}" --set network.grid.columns=2 --set network.grid.rows=2 \
    --set "measure.time_space=30 s"
expect_all_explained grid Networks 8
run streets "$STOPLINE_SOURCE/scenarios/berlin.yaml" "${network[@]}"
expect_all_explained streets Networks 10
cp "$STOPLINE_SOURCE"/tests/data/fast_random.*.xml "$work"
cat >"$work/imported.yaml" <<'END'
fidelity: meso
network: {kind: sumo, net: ./fast_random.net.xml, routes: ./fast_random.rou.xml}
END
run imported "$work/imported.yaml" "${network[@]}"
expect_all_explained imported Networks 7
run intersection "$STOPLINE_SOURCE/scenarios/intersection.yaml" "${brief[@]}" --set measure.cycles=1
expect_all_explained intersection "Single intersection" 3
run light "$STOPLINE_SOURCE/scenarios/first_steps.yaml" "${brief[@]}"
expect_all_explained light "Single light" 4

# sweep NAME SCENARIO [OPTION...]: over greens, with two seeds
sweep() {
    local name=$1 scenario=$2
    shift 2
    cat >"$work/$name.yaml" <<END
scenario: $scenario
axes: [{name: entering, path: demand.entry_speed, values: [36 km/h, 50 km/h]}]
repetitions: 2
END
    "$STOPLINE_BIN/stopline-sweep" "$work/$name.yaml" --output "$work/sweeps" "$@" >"$work/stdout" 2>"$work/stderr" ||
        fail "sweep of $name: exit code $?: $(tail -n 3 "$work/stderr")"
    expect_explained "$work/sweeps/$name.csv" "Sweeps: NAME.csv" entering_kmh
    expect_explained "$work/sweeps/${name}_means.csv" "Sweeps: NAME_means.csv" population entering_kmh
}
network=(--set 'populations=[CDG]' --set measure.baseline=CDG --set "duration=130 s" --set "measure.steady=60 s")
sweep of_grid "$STOPLINE_SOURCE/scenarios/grid.yaml" "${network[@]}" --set network.grid.columns=2 --set network.grid.rows=2
sweep of_streets "$STOPLINE_SOURCE/scenarios/berlin.yaml" "${network[@]}"
sweep of_intersection "$STOPLINE_SOURCE/scenarios/intersection.yaml" --set measure.cycles=1 --set 'populations=[CDG]' \
    --set measure.baseline=CDG
sweep of_light "$STOPLINE_SOURCE/scenarios/first_steps.yaml"

# The check sees what is missing.
head -n 1 "$work/grid/ways.csv" | sed 's/$/,new_column/' >"$work/more.csv"
before=$failures
expect_explained "$work/more.csv" "Networks: ways.csv" >"$work/stdout"
[ $failures -eq $((before + 1)) ] || echo "FAILED: a column that nobody explained is not found"
[ $failures -eq $((before + 1)) ] && failures=$before

exit $((failures > 0))
