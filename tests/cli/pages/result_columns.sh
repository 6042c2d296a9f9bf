#!/usr/bin/env bash
# Tests that scenarios/COLUMNS.md, `stopline-run --describe-columns` and the result tables agree. The page is the output
# of the program, every column of a table has a description, and every described column appears in a table.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

"$STOPLINE_BIN/stopline-run" --describe-columns >"$work/page" || fail "--describe-columns: exit code $?"
cmp "$work/page" "$STOPLINE_SOURCE/scenarios/COLUMNS.md" ||
    fail "scenarios/COLUMNS.md is out of date; write it with: stopline-run --describe-columns >scenarios/COLUMNS.md"

# check FILE TABLE [AXIS...]: expects the page to describe each column of FILE under the heading TABLE, except each AXIS
# (a column of a sweep axis). Stores the columns of FILE for check_complete.
check() {
    expect_documented "$@"
    [ -s "$1" ] && head -n 1 "$1" | tr ',' '\n' >>"$work/columns_of.${2//\//.}"
}

# check_complete TABLE: expects that each column described under the heading TABLE occurs in one of the files for which
# check() was called. Skips described names with CAPITALS, because CAPITALS stand for any word.
check_complete() {
    local column
    while read -r column; do
        grep -qxF -- "$column" "$work/columns_of.${1//\//.}" || fail "$1: no file has the column '$column'"
    done < <(columns_of "$1" | grep -v '[A-Z]')
}

# check_all FOLDER GROUP COUNT: checks each table in FOLDER under the heading GROUP/FILE, and expects at least COUNT
# tables
check_all() {
    local file tables=0
    for file in "$work/$1"/*.csv; do
        check "$file" "$2/$(basename "$file")"
        tables=$((tables + 1))
    done
    [ $tables -ge "$3" ] || fail "$1: $tables tables instead of at least $3"
}

# run FOLDER SCENARIO [OPTION...]: runs a scenario with results in FOLDER
run() {
    local folder=$1 scenario=$2
    shift 2
    "$STOPLINE_BIN/stopline-run" "$scenario" --no-figures --output "$work/$folder" "$@" >"$work/stdout" 2>"$work/stderr" ||
        fail "$folder: exit code $?: $(tail -n 3 "$work/stderr")"
}

brief=(--set 'populations=[CDG]' --set measure.baseline=CDG --trajectories --interval "10 s"
    --set measure.departure_delay=on --set measure.energy=on --set measure.surrogate_safety=on --set measure.hcm=on)
network=("${brief[@]}" --set "duration=130 s" --set "measure.window=60 s")
run grid "$STOPLINE_SOURCE/scenarios/grid.yaml" "${network[@]}" --set network.grid.columns=2 --set network.grid.rows=2 \
    --set "measure.time_space=30 s"
check_all grid network 10
run streets "$STOPLINE_SOURCE/scenarios/berlin.yaml" "${network[@]}" --set driver.lane_change.gap_opening=cooperative \
    --set driver.speed_advice.mode=glosa
check_all streets network 12
cp "$STOPLINE_SOURCE"/tests/data/fast_random.*.xml "$work"
cat >"$work/imported.yaml" <<'END'
fidelity: meso
network: {kind: sumo, net: ./fast_random.net.xml, routes: ./fast_random.rou.xml}
END
run imported "$work/imported.yaml" "${network[@]}"
check_all imported network 9
run intersection "$STOPLINE_SOURCE/scenarios/intersection.yaml" "${brief[@]}" --set measure.cycles=1
check_all intersection intersection 5
run light "$STOPLINE_SOURCE/scenarios/first_steps.yaml" "${brief[@]}" --set measure.string_stability=on
check_all light single_light 6
# Runs with a radio channel also write the changes of driving modes.
radio=(--set fidelity=full --set 'driver.v2v={channel: bernoulli, loss: 50 %}' --set 'populations=[CDG]'
    --set measure.baseline=CDG)
run radio_grid "$STOPLINE_SOURCE/scenarios/grid.yaml" "${radio[@]}" --set "duration=40 s" --set "measure.window=20 s" \
    --set network.grid.columns=2 --set network.grid.rows=2
check "$work/radio_grid/v2v_modes.csv" network/v2v_modes.csv
run radio_intersection "$STOPLINE_SOURCE/scenarios/intersection.yaml" "${radio[@]}" --set measure.cycles=1
check "$work/radio_intersection/v2v_modes.csv" intersection/v2v_modes.csv
run radio_light "$STOPLINE_SOURCE/scenarios/first_steps.yaml" "${radio[@]}"
check "$work/radio_light/v2v_modes.csv" single_light/v2v_modes.csv
while read -r table; do check_complete "$table"; done < \
    <(grep -oE '^## (network|intersection|single_light)/.*' "$work/page" | cut -c4-)

# sweep NAME SCENARIO [OPTION...]: runs a sweep over entry speeds with two seeds and checks its tables
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
    check "$work/sweeps/$name.csv" sweep/NAME.csv entering_kmh
    check "$work/sweeps/${name}_means.csv" sweep/NAME_means.csv population entering_kmh
}
network=(--set 'populations=[CDG]' --set measure.baseline=CDG --set "duration=130 s" --set "measure.window=60 s"
    --set measure.departure_delay=on --set measure.energy=on --set measure.surrogate_safety=on --set measure.hcm=on)
sweep of_grid "$STOPLINE_SOURCE/scenarios/grid.yaml" "${network[@]}" --set network.grid.columns=2 --set network.grid.rows=2
sweep of_streets "$STOPLINE_SOURCE/scenarios/berlin.yaml" "${network[@]}" --set driver.lane_change.gap_opening=cooperative \
    --set driver.speed_advice.mode=glosa
sweep of_intersection "$STOPLINE_SOURCE/scenarios/intersection.yaml" --set measure.cycles=1 --set 'populations=[CDG]' \
    --set measure.baseline=CDG
sweep of_light "$STOPLINE_SOURCE/scenarios/first_steps.yaml" --set measure.string_stability=on
check_complete sweep/NAME.csv
check_complete sweep/NAME_means.csv

"$STOPLINE_BIN/stopline-startup" --no-figures --output "$work/startup" >"$work/stdout" || fail "stopline-startup: exit code $?"
check_all startup startup 2

"$STOPLINE_BIN/stopline-strings" --no-figures --population CTG-Ref --vehicles 3 \
    --frequency 2 --output "$work/strings" >"$work/stdout" || fail "stopline-strings: exit code $?"
"$STOPLINE_BIN/stopline-strings" --no-figures --population CTG-Ref --vehicles 3 \
    --frequency 2 --sweep --delays '20 ms' --time-gaps '1 s' --output "$work/strings" >"$work/stdout" ||
    fail "stopline-strings --sweep: exit code $?"
check_all strings strings 5
for table in summary positions gains sweep border; do check_complete "strings/$table.csv"; done

"$STOPLINE_BIN/stopline-signals" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --set demand.kind=rate \
    --set network.grid.columns=2 --set 'duration=120 s' --set 'measure.window=60 s' --population CTG-Ref --search \
    --seeds 1 --greens 1 --offsets 1 --no-figures --output "$work/signals" >"$work/stdout" || fail "stopline-signals: exit code $?"
mv "$work/signals/search_CTG-Ref.csv" "$work/signals/search_POPULATION.csv"
check_all signals signals 4
for table in timing lanes search search_POPULATION; do check_complete "signals/$table.csv"; done

# Tests the check itself: a column without a description must be reported.
head -n 1 "$work/grid/delays.csv" | sed 's/$/,new_column/' >"$work/extra.csv"
before=$failures
expect_documented "$work/extra.csv" network/delays.csv >"$work/stdout"
if [ $failures -eq $((before + 1)) ]; then
    failures=$before
else
    fail "the check accepts a column without a description"
fi

exit $((failures > 0))
