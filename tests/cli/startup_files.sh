#!/usr/bin/env bash
# stopline-startup: measured starts that cannot be used are refused with file and line; what it says of those that can be is
# in their file; its provenance makes the results again.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
startup="$STOPLINE_BIN/stopline-startup"
data="$STOPLINE_SOURCE/data/startup"

# refused PART TEXT: a file of that text ends with exit code 2 and PART in the message, which is plain text
refused() {
    local part=$1 code=0
    printf '%b' "$2" >"$work/starts.csv"
    timeout 60 "$startup" --measured "$work/starts.csv" --output "$work/out" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$2: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$2: no '$part' in: $(head -c 300 "$work/stderr" | tr -d '\033')"
    LC_ALL=C grep -q $'[^[:print:]\t]' "$work/stderr" && fail "$2: control characters in the message"
    [ -s "$work/stdout" ] && fail "$2: writes to standard output"
    [ -e "$work/out" ] && fail "$2: leaves results behind"
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
refused "starts.csv:3: 1 fields" "${head}0,0\n1\n"
refused "at least two rows" "${head}0,0\n"
refused "is empty" ""
refused "required columns: t_s, mean_kmh" "time,speed\n0,0\n1,3\n"
refused "'p97.5'" "t_s,mean_kmh,p2.5\n0,0,0\n1,3,2\n"
refused "starts.csv:2: byte 0x1B" "${head}\033[31m,0\n1,3\n"
refused "starts.csv:1: byte 0xFF" '\0377\0376'

# says FILE: what the program says of a file
says() {
    "$startup" --measured "$1" --no-figures --output "$work/other" >"$work/stdout" 2>"$work/stderr" || fail "$1: exit code $?"
}
says "$data/kit_curve_leader50.csv"
grep -qF "117 starts; half width at most 1.5 km/h" "$work/stdout" || fail "not said: 117 starts"
grep -qE "2\.55 to +2\.90 s.*gear change 1-2 at 2\.80 s" "$work/stdout" || fail "not said: ahead until gear change 1-2, between measured points"
grep -qE "lag|gear change before|gear change 3-4" "$work/stdout" && fail "an explanation that is not known"
says "$data/kit_curve.csv"
grep -qF "213 starts; half width at most 1.1 km/h" "$work/stdout" || fail "not said: 213 starts"
says "$data/stuttgart_curve.csv"
grep -qE "117|95 %|percent|single starts" "$work/stdout" && fail "bands and counts that the file does not have"
says "$data/ostfalia_curve.csv"
grep -qE "117|95 %|percent|single starts" "$work/stdout" && fail "bands and counts that the file does not have"

# The command of the provenance makes the results again.
provenance="$work/other/startup.provenance.json"
grep -qF -- "--measured $data/ostfalia_curve.csv" "$provenance" || fail "no --measured in the provenance"
for file in startup.csv startup_fine.csv; do
    grep -qF "\"$file\"" "$provenance" || fail "no $file in the provenance"
    [ -s "$work/other/$file" ] || fail "no $file"
done
"$startup" --no-figures --output "$work/plain" >/dev/null || fail "exit code $?"
grep -q '"command": "stopline-startup"' "$work/plain/startup.provenance.json" || fail "another command than was given"

exit $((failures > 0))
