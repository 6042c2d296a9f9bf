#!/usr/bin/env bash
# Tests that stopline-run refuses invalid SUMO files of each kind with exit code 2, nothing on standard output, and a
# message with path and line. If no vehicle departs within the run, it warns.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
run="$STOPLINE_BIN/stopline-run"

net='<net version="1.20">
<edge id="e" from="A" to="B"><lane id="e_0" index="0" speed="13.89" length="200" shape="0,0 200,0"/></edge>
<junction id="A" type="dead_end" x="0" y="0"/><junction id="B" type="dead_end" x="200" y="0" incLanes="e_0"/>
</net>'
routes='<routes>
<vehicle id="a" depart="0" departLane="best" departSpeed="max"><route edges="e"/></vehicle>
</routes>'
additional='<additional>
</additional>'

# run_expecting CASE CODE: runs the scenario with the files in $work and expects exit code CODE
run_expecting() {
    timeout 60 "$run" "$work/s.yaml" --no-figures --output "$work/out" >"$work/stdout" 2>"$work/stderr"
    local code=$?
    [ $code -eq "$2" ] || fail "$1: exit code $code instead of $2: $(head -c 300 "$work/stderr")"
}

# message_has CASE PART: expects PART on standard error
message_has() { grep -qF -- "$2" "$work/stderr" || fail "$1: '$2' is missing in: $(head -c 500 "$work/stderr")"; }

# scenario [NET [ROUTES [ADDITIONAL]]]: writes a valid scenario with these file names, and valid files
scenario() {
    printf 'fidelity: meso\nduration: 60 s\nnetwork:\n  kind: sumo\n  net: %s\n  routes: [%s]\n  additional: [%s]\npopulations: [CTG-Ref]\n' \
        "${1:-./net.xml}" "${2:-./rou.xml}" "${3:-./add.xml}" >"$work/s.yaml"
    printf '%s' "$net" >"$work/net.xml"
    printf '%s' "$routes" >"$work/rou.xml"
    printf '%s' "$additional" >"$work/add.xml"
    rm -rf "$work/out"
}

# refused CASE PART: expects exit code 2, PART in the message, nothing on standard output, and no results
refused() {
    run_expecting "$1" 2
    message_has "$1" "$2"
    [ -s "$work/stdout" ] && fail "$1: standard output is not empty"
    [ -e "$work/out" ] && fail "$1: results are left behind"
}

scenario
run_expecting "valid files" 0
[ -s "$work/stderr" ] && fail "valid files: standard error is not empty: $(head -c 300 "$work/stderr")"

# The defaults of departLane and departSpeed depend on the version of SUMO, so the run says which ones it uses.
scenario
sed -i 's/ departSpeed="max"//' "$work/rou.xml"
run_expecting "no departSpeed" 0
message_has "no departSpeed" "note: $work/rou.xml: departLane=\"best_prob\" departSpeed=\"avg\" (the defaults since SUMO 1.27;"
[ "$(wc -l <"$work/stderr")" -eq 1 ] || fail "no departSpeed: standard error has other lines: $(head -c 300 "$work/stderr")"

for file in net rou add; do
    scenario
    : >"$work/$file.xml"
    refused "$file: empty" "$work/$file.xml:1: the file is empty"
    scenario
    printf '<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "b">]>\n%s' "$(cat "$work/$file.xml")" >"$work/whole"
    mv "$work/whole" "$work/$file.xml"
    refused "$file: DOCTYPE" "$work/$file.xml:2: the file has a DOCTYPE"
    scenario
    {
        cat "$work/$file.xml"
        head -c 20000 /dev/urandom | od -A n -t x1
    } | gzip >"$work/whole"
    head -c 5000 "$work/whole" >"$work/$file.xml"
    refused "$file: cut off" ": the gzip data are damaged or end too early here"
    message_has "$file: cut off" "$work/$file.xml:"
    scenario
    sed -i '1s/>/ a="1" a="2">/' "$work/$file.xml"
    refused "$file: attribute twice" "$work/$file.xml:1: element '"
    scenario
    sed -i '1s/>/ a="\&unknown;">/' "$work/$file.xml"
    refused "$file: unknown entity" "'&unknown' is not an XML entity"
    scenario
    rm "$work/$file.xml"
    refused "$file: missing" "$work/$file.xml: there is no such file"
done
scenario ./none.xml
refused "missing net" "$work/s.yaml:5:8: field 'network.net': "
scenario "" /dev/zero
refused "device as routes" "$work/s.yaml:6:12: field 'network.routes[0]': /dev/zero: this is a device or a pipe; a regular file is needed"
scenario "" "" .
refused "folder as additional" "$work/s.yaml:7:16: field 'network.additional[0]': "

scenario
echo '<routes><vType id="t"/></routes>' >"$work/rou.xml"
refused "no vehicle" "$work/s.yaml:6:11: field 'network.routes': the files of 'routes' and 'additional' have no vehicle, trip or flow"
scenario
sed -i 's/depart="0"/depart="60"/' "$work/rou.xml"
run_expecting "no vehicle departs" 0
message_has "no vehicle departs" "warning: no vehicle departs: the run ends at 60 s (duration), but the first vehicle departs at 60 s"

exit $((failures > 0))
