#!/usr/bin/env bash
# stopline-compare and stopline-export: what is refused leaves no folders behind, and a fidelity that is not used is told.
# SUMO need not be installed.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
scenarios="$STOPLINE_SOURCE/scenarios"

# refused WHAT COMMAND...
refused() {
    local what=$1
    shift
    timeout 60 "$@" >"$work/stdout" 2>"$work/stderr"
    local code=$?
    [ $code -eq 2 ] || fail "$what: exit code $code instead of 2: $(head -c 300 "$work/stderr")"
    [ -e "$work/new" ] && fail "$what: leaves $(find "$work/new")"
    rm -rf "$work/new"
}

compare="$STOPLINE_BIN/stopline-compare"
refused "pockets" "$compare" "$scenarios/berlin.yaml" --output "$work/new/a"
refused "unknown population" "$compare" "$scenarios/single_light.yaml" --population Nobody --output "$work/new/a"
mkdir "$work/old"
refused "folder that was there" "$compare" "$scenarios/berlin.yaml" --output "$work/old"
[ -d "$work/old" ] || fail "a folder that was there is gone"
[ -z "$(ls -A "$work/old")" ] || fail "in a folder that was there: $(ls -A "$work/old")"

# told WHAT COMMAND...: standard error says that another fidelity is used.
told() {
    local what=$1
    shift
    timeout 60 "$@" >"$work/stdout" 2>"$work/stderr"
    grep -qF "'fidelity=full' is not used: this program runs the mesoscale mode" "$work/stderr" ||
        fail "$what: not told: $(head -c 300 "$work/stderr")"
}

export_light=("$STOPLINE_BIN/stopline-export" --sumo "$work/made" "$scenarios/single_light.yaml")
told "export" "${export_light[@]}" --set fidelity=full
told "compare" "$compare" "$scenarios/berlin.yaml" --output "$work/new/a" --set fidelity=full
"${export_light[@]}" --set fidelity=meso >"$work/stdout" 2>"$work/stderr" || fail "export: $(head -c 300 "$work/stderr")"
grep -qF fidelity "$work/stderr" && fail "told without need"

exit $((failures > 0))
