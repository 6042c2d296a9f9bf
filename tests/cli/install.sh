#!/usr/bin/env bash
# Tests `cmake --install`: the installed programs find their data and scenarios from any folder, without the source
# tree.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

build="$(dirname "$STOPLINE_BIN")"
cmake --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || fail "cmake --install: $(tail -n 3 "$work/log")"
for program in "$STOPLINE_BIN"/stopline-*; do
    case "$(basename "$program")" in *_test) continue ;; esac
    [ -x "$work/prefix/bin/$(basename "$program")" ] || fail "$(basename "$program") was not installed"
done
share="$work/prefix/share/stopline"
[ -f "$share/scenarios/first_steps.yaml" ] || fail "the scenarios were not installed"

# Other data than those of the source tree show which folder the program reads.
sed -i 's/^- name: CDG$/- name: CDG-installed/' "$share/data/policies/paper.yaml"
mkdir "$work/elsewhere"
cd "$work/elsewhere" || exit 1
PATH="$work/prefix/bin:$PATH"
unset STOPLINE_DATA
stopline-run --list >"$work/list" || fail "--list: exit code $?"
grep -q "CDG-installed" "$work/list" || fail "stopline-run does not read the installed data"
stopline-run "$share/scenarios/first_steps.yaml" --set 'populations=[CTG-Ref]' --set 'measure.baseline=CTG-Ref' \
    --no-figures >"$work/report" || fail "first_steps: exit code $?"
[ -s out/first_steps/summary.csv ] || fail "there is no out/first_steps/summary.csv in the present folder"
# Examples in the help name scenarios that exist.
stopline-run --help >"$work/help"
grep -q "$share/scenarios/single_light.yaml" "$work/help" || fail "the help does not name the installed scenario"

exit $((failures > 0))
