#!/usr/bin/env bash
# Tests stopline-compare and stopline-export without SUMO. Refused input leaves no folder behind. Both
# programs ignore the setting `fidelity=full` and say so.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
scenarios="$STOPLINE_SOURCE/scenarios"

# refused CASE COMMAND...: expects exit code 2 and no folder $work/new
refused() {
    local case_name=$1
    shift
    timeout 60 "$@" >"$work/stdout" 2>"$work/stderr"
    local code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2: $(head -c 300 "$work/stderr")"
    [ -e "$work/new" ] && fail "$case_name: files or folders are left: $(find "$work/new")"
    rm -rf "$work/new"
}

compare="$STOPLINE_BIN/stopline-compare"
refused "unknown population" "$compare" "$scenarios/single_light.yaml" --population Nobody --output "$work/new/a"
mkdir "$work/old"
refused "existing folder" "$compare" "$scenarios/single_light.yaml" --population Nobody --output "$work/old"
[ -d "$work/old" ] || fail "an existing folder was removed"
[ -z "$(ls -A "$work/old")" ] || fail "files are left in an existing folder: $(ls -A "$work/old")"

# message_has CASE PART: expects PART in the message of the last refused command
message_has() { grep -qF -- "$2" "$work/stderr" || fail "$1: '$2' is missing in: $(head -c 500 "$work/stderr")"; }

export_new=("$STOPLINE_BIN/stopline-export" --sumo "$work/new")
refused "export of a controller that reacts to traffic" "${export_new[@]}" "$scenarios/dual_ring.yaml"
message_has "controller" "$scenarios/dual_ring.yaml: field 'signal.controller': value 'dual_ring' reacts to traffic"
message_has "controller" "controllers that can be exported: fixed_time"
data="$STOPLINE_SOURCE/tests/data"
printf 'network: {kind: sumo, net: %s/roundabout.net.xml, routes: [%s/roundabout.rou.xml]}\nduration: 60 s\n' \
    "$data" "$data" >"$work/imported.yaml"
refused "export of an imported network" "${export_new[@]}" "$work/imported.yaml"
message_has "imported network" "$work/imported.yaml: field 'network.kind': value 'sumo' cannot be exported"

# reports_fidelity CASE COMMAND...: expects a message on standard error that the fidelity is not used
reports_fidelity() {
    local case_name=$1
    shift
    timeout 60 "$@" >"$work/stdout" 2>"$work/stderr"
    grep -qF "'fidelity=full' is not used: this program runs the mesoscale mode" "$work/stderr" ||
        fail "$case_name: the message is missing in: $(head -c 300 "$work/stderr")"
}

export_light=("$STOPLINE_BIN/stopline-export" --sumo "$work/exported" "$scenarios/single_light.yaml")
reports_fidelity "export" "${export_light[@]}" --set fidelity=full
reports_fidelity "compare" "$compare" "$scenarios/single_light.yaml" --population Nobody --output "$work/new/a" \
    --set fidelity=full
"${export_light[@]}" --set fidelity=meso >"$work/stdout" 2>"$work/stderr" || fail "export: $(head -c 300 "$work/stderr")"
grep -qF fidelity "$work/stderr" && fail "the message appears without need"

"$STOPLINE_BIN/stopline-export" --sumo "$work/streets" "$scenarios/berlin.yaml" --set 'duration=60 s' \
    --set 'measure.window=1 s' >"$work/stdout" 2>"$work/stderr" || fail "export of streets: $(head -c 300 "$work/stderr")"
grep -qF '<edge id="suarezstr_east_in.1"' "$work/streets/edges.edg.xml" || fail "the approach with a pocket is not split"

# A program that never ends takes the place of SUMO. The time limit stops it, and the message says how far it came.
mkdir "$work/bin"
printf '#!/bin/sh\nexit 0\n' >"$work/bin/netconvert"
cat >"$work/bin/sumo" <<'END'
#!/bin/sh
[ "$1" = --version ] && exit 0
printf 'Step #12.00 (0ms)\r'
exec sleep 60
END
chmod +x "$work/bin/netconvert" "$work/bin/sumo"
cat >"$work/slow.yaml" <<END
fidelity: meso
duration: 60 s
network: {kind: sumo, net: $data/left_turns.net.xml, routes: [$data/left_turns.rou.xml]}
populations: [CTG-Ref]
measure: {window: 60 s}
END
slow=(env "PATH=$work/bin:$PATH" "$compare" "$work/slow.yaml" --repetitions 1 --no-figures)
code=0
"${slow[@]}" --sumo-limit "1 s" --output "$work/slow" >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 2 ] || fail "slow SUMO: exit code $code"
[ -s "$work/slow/seed_1/run.sumocfg" ] || fail "slow SUMO: the inputs are not kept"
grep -qF "SUMO was stopped after 1 s of wall-clock time. It had simulated 12 of 60 s" "$work/stderr" ||
    fail "slow SUMO: $(head -c 300 "$work/stderr")"
refused "wrong limit" "${slow[@]}" --sumo-limit "1" --output "$work/new"
grep -qF -- "--sumo-limit" "$work/stderr" || fail "wrong limit: $(head -c 300 "$work/stderr")"

# Another program in place of SUMO reports trips without departure delay. Our vehicles have none either.
cat >"$work/bin/sumo" <<'END'
#!/bin/sh
[ "$1" = --version ] && exit 0
echo '<tripinfos><tripinfo id="a" arrival="30.00" duration="29.70" departDelay="0.00"/></tripinfos>' >trips.out.xml
echo '<instantE1></instantE1>' >detectors.out.xml
echo '<summary><step time="10.00" running="1" waiting="0" halting="0" meanSpeed="5.00" teleports="0"/></summary>' >summary.out.xml
END
{
    echo '<routes>'
    for depart in 0.3 2.7 5.1 7.3 9.9 12.7; do
        echo "<trip id=\"t$depart\" depart=\"$depart\" from=\"ni\" to=\"so\" departSpeed=\"max\"/>"
    done
    echo '</routes>'
} >"$work/few.rou.xml"
sed "s#$data/left_turns.rou.xml#$work/few.rou.xml#; s/60 s/120 s/" "$work/slow.yaml" >"$work/few.yaml"
env "PATH=$work/bin:$PATH" "$compare" "$work/few.yaml" --no-figures --output "$work/few" >"$work/stdout" 2>"$work/stderr" ||
    fail "no departure delay: $(head -c 300 "$work/stderr")"
grep -qE '^ *departure_delay_s +0\.00 +0\.00 +- +0\.00 \.\. 0\.00 +yes +0\.00 \.\. 0\.00 +yes *$' "$work/stdout" ||
    fail "no departure delay: $(grep departure_delay_s "$work/stdout")"

exit $((failures > 0))
