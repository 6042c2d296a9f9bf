#!/usr/bin/env bash
# Tests stopline-startup: invalid measured starts are refused with file and line, the report matches the measured file,
# and the provenance is complete.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
startup="$STOPLINE_BIN/stopline-startup"
data="$STOPLINE_SOURCE/data/startup"

# refused PART TEXT: expects exit code 2 and a plain-text message with PART for a file with this TEXT
refused() {
    local part=$1 code=0
    printf '%b' "$2" >"$work/starts.csv"
    timeout 60 "$startup" --measured "$work/starts.csv" --output "$work/out" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$2: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$2: '$part' is missing in: $(head -c 300 "$work/stderr" | tr -d '\033')"
    LC_ALL=C grep -q $'[^[:print:]\t]' "$work/stderr" && fail "$2: the message has control characters"
    [ -s "$work/stdout" ] && fail "$2: standard output is not empty"
    [ -e "$work/out" ] && fail "$2: results are left behind"
}

head='t_s,mean_kmh\n'
refused "starts.csv:3: column 't_s': value '-5'" "${head}0,0\n-5,3\n"
refused "starts.csv:4: column 't_s': value '1' must be greater than the time before it" "${head}0,0\n1,3\n1,4\n"
refused "starts.csv:2: column 't_s': value '0.5' must be 0" "${head}0.5,0\n1,3\n"
refused "starts.csv:3: column 't_s': value '1e7' is out of range (allowed: 0 to 600)" "${head}0,0\n1e7,3\n"
refused "starts.csv:3: column 'mean_kmh': value 'nan'" "${head}0,0\n1,nan\n"
refused "starts.csv:3: column 'mean_kmh': value 'inf'" "${head}0,0\n1,inf\n"
refused "starts.csv:3: column 'mean_kmh': value '5xyz' is not a number" "${head}0,0\n1,5xyz\n"
refused "starts.csv:3: column 'mean_kmh': value ''" "${head}0,0\n1,\n"
refused "starts.csv:3: the number of fields is 1" "${head}0,0\n1\n"
refused "at least two rows" "${head}0,0\n"
refused "is empty" ""
refused "required columns: t_s, mean_kmh" "time,speed\n0,0\n1,3\n"
refused "'p97.5'" "t_s,mean_kmh,p2.5\n0,0,0\n1,3,2\n"
refused "starts.csv:2: byte 0x1B" "${head}\033[31m,0\n1,3\n"
refused "starts.csv:1: byte 0xFF" '\0377\0376'

# report FILE: writes the program's report on a measured file to $work/stdout
report() {
    "$startup" --measured "$1" --no-figures --output "$work/other" >"$work/stdout" 2>"$work/stderr" || fail "$1: exit code $?"
}
report "$data/kit_curve_leader50.csv"
grep -qF "117 starts; half width at most 1.5 km/h" "$work/stdout" || fail "117 starts are not reported"
grep -qE "2\.55 to +2\.90 s.*gear change 1-2 at 2\.80 s" "$work/stdout" || fail "the deviation before gear change 1-2 is not reported"
grep -qE "lag|gear change before|gear change 3-4" "$work/stdout" && fail "the report has an explanation without evidence"
report "$data/kit_curve.csv"
grep -qF "213 starts; half width at most 1.1 km/h" "$work/stdout" || fail "213 starts are not reported"
report "$data/stuttgart_curve.csv"
grep -qE "117|95 %|percent|single starts" "$work/stdout" && fail "the report has bands or counts that the file lacks"
report "$data/ostfalia_curve.csv"
grep -qE "117|95 %|percent|single starts" "$work/stdout" && fail "the report has bands or counts that the file lacks"

# The provenance has the command and the files.
provenance="$work/other/startup.provenance.json"
grep -qF -- "--measured $data/ostfalia_curve.csv" "$provenance" || fail "--measured is missing in the provenance"
for file in startup.csv startup_fine.csv; do
    grep -qF "\"$file\"" "$provenance" || fail "$file is missing in the provenance"
    [ -s "$work/other/$file" ] || fail "$file is missing or empty"
done
"$startup" --no-figures --output "$work/plain" >/dev/null || fail "exit code $?"
grep -q '"command": "stopline-startup"' "$work/plain/startup.provenance.json" || fail "the command in the provenance is wrong"

exit $((failures > 0))
