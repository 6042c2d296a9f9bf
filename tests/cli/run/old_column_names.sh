#!/usr/bin/env bash
# Tests --old-column-names: it writes tables with the names of the previous release and warns. The numbers are the same.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
warning="warning: --old-column-names: the next release removes this option"

# header FILE TEXT: expects TEXT in the first line of FILE
header() {
    head -n 1 "$work/$1" | grep -qF -- "$2" || fail "$1 begins with: $(head -n 1 "$work/$1" 2>&1)"
}

# same_numbers FILE OLD_FILE: expects the same numbers in all lines but the first
same_numbers() {
    cmp <(tail -n +2 "$work/$1" | grep -oE '[0-9][0-9.]*') <(tail -n +2 "$work/$2" | grep -oE '[0-9][0-9.]*') ||
        fail "$1 and $2 have different numbers"
}

run=("$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/grid.yaml" --no-figures --set 'populations=[CDG]'
    --set measure.baseline=CDG --set "duration=130 s" --set "measure.window=60 s" --set network.grid.columns=2
    --set network.grid.rows=2 --trajectories --interval "10 s")
"${run[@]}" --output "$work/new" >"$work/stdout" 2>"$work/stderr" || fail "exit code $?: $(tail -n 3 "$work/stderr")"
grep -qF -- "$warning" "$work/stderr" && fail "a warning without the option"
"${run[@]}" --output "$work/old" --old-column-names >"$work/stdout" 2>"$work/stderr" ||
    fail "exit code $?: $(tail -n 3 "$work/stderr")"
grep -qF -- "$warning" "$work/stderr" || fail "no warning in: $(cat "$work/stderr")"
header old/summary.csv "first_gridlock_s,starvations,moved_on,passed_blockers,refused,refused_stop_h,lost_signal_h,lost_priority_h,"
header old/summary.csv "lost_start_h,lost_refusal_h,lost_outside_h,longest_stand_s,stops_per_vehicle,longest_inside_s,entered,left,"
header old/hindrance.csv "from_s,to_s,most_vehicles,lost_s"
header old/ways.csv "population,from,to,throughput_veh_h,travel_time_s"
header old/trajectories.csv "population,time_s,vehicle,policy,lane,place_m,x_m"
header new/trajectories.csv "population,time_s,vehicle,policy,lane,position_m,x_m"
for file in summary series gridlocks rules trajectories; do same_numbers "new/$file.csv" "old/$file.csv"; done
same_numbers new/delays.csv old/hindrance.csv
same_numbers new/origin_destination.csv old/ways.csv
grep -qF '"hindrance.csv"' "$work/old/grid.provenance.json" || fail "the provenance does not list hindrance.csv"
grep -qF -- "--old-column-names" "$work/old/grid.provenance.json" || fail "the command in the provenance lacks the option"
[ -e "$work/old/delays.csv" ] && fail "delays.csv exists besides hindrance.csv"

cat >"$work/light.yaml" <<END
scenario: $STOPLINE_SOURCE/scenarios/first_steps.yaml
axes: [{name: entering, path: demand.entry_speed, values: [36 km/h, 50 km/h]}]
repetitions: 2
END
sweep=("$STOPLINE_BIN/stopline-sweep" "$work/light.yaml")
"${sweep[@]}" --output "$work/new_sweep" >"$work/stdout" 2>"$work/stderr" || fail "sweep: exit code $?"
"${sweep[@]}" --output "$work/old_sweep" --old-column-names >"$work/stdout" 2>"$work/stderr" || fail "sweep: exit code $?"
grep -qF -- "$warning" "$work/stderr" || fail "sweep: no warning in: $(cat "$work/stderr")"
header old_sweep/light.csv ",emptied_s,settled_veh,not_closed_up_vehicles,settled_headway_s,settled_net_gap_m,vehicles_entered,vehicles_left,"
header old_sweep/light_means.csv ",metric,runs,mean,low,high,difference,difference_low,difference_high"
grep -q ',settled_headway_s,' "$work/old_sweep/light_means.csv" || fail "light_means.csv has new names of metrics"
same_numbers new_sweep/light.csv old_sweep/light.csv
same_numbers new_sweep/light_means.csv old_sweep/light_means.csv

startup=("$STOPLINE_BIN/stopline-startup" --no-figures)
"${startup[@]}" --output "$work/new_startup" >"$work/stdout" 2>"$work/stderr" || fail "startup: exit code $?"
grep -qF -- "$warning" "$work/stderr" && fail "startup: a warning without the option"
"${startup[@]}" --output "$work/old_startup" --old-column-names >"$work/stdout" 2>"$work/stderr" || fail "startup: exit code $?"
grep -qF -- "$warning" "$work/stderr" || fail "startup: no warning in: $(cat "$work/stderr")"
header new_startup/startup.csv ",mean_ci95_kmh,p2.5_kmh,p97.5_kmh,gear"
header old_startup/startup.csv ",mean_ci95_kmh,low_2.5_kmh,high_97.5_kmh,gear"
same_numbers new_startup/startup.csv old_startup/startup.csv

exit $((failures > 0))
