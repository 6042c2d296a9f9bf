#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 900
# Tests that the commands of the guides work as they are printed. In a guide, a comment marks each block that this test
# runs. tests/tools/guide_blocks.py describes these comments.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

guides=(README.md scenarios/README.md scenarios/SWEEPS.md scenarios/CALIBRATION.md scenarios/SUMO.md scenarios/HCM.md
    data/paper/README.md data/README.md core/README.md tests/README.md)

# can_run PROGRAM: succeeds if PROGRAM is installed; for mpirun the programs must also be built with MPI
can_run() {
    command -v "$1" >/dev/null && { [ "$1" != mpirun ] || ldd "$STOPLINE_BIN/stopline-sweep" | grep -q libmpi; }
}

# run_guide GUIDE: runs the marked blocks of GUIDE, in order, in a folder that looks like the project after the build
run_guide() {
    local guide=$1 folder="$work/run/$1" blocks="$work/blocks/$1" block
    [ -s "$STOPLINE_SOURCE/$guide" ] || { fail "$guide is missing"; return; }
    mkdir -p "$folder/build/release" "$blocks"
    cp -r "$STOPLINE_SOURCE/scenarios" "$STOPLINE_SOURCE/data" "$folder"
    ln -s "$STOPLINE_SOURCE"/{core,apps,tests} "$folder"
    ln -s "$STOPLINE_BIN" "$folder/build/release/bin"
    if ! python3 "$STOPLINE_SOURCE/tests/tools/guide_blocks.py" "$STOPLINE_SOURCE/$guide" "$folder" "$blocks" >"$work/list"; then
        fail "$guide: its blocks cannot be read"
        return
    fi
    [ -s "$work/list" ] || fail "$guide has no tested block"
    while read -r block line needed; do
        if [ -n "$needed" ] && ! can_run "$needed"; then
            echo "$guide:$line: skipped, because '$needed' is missing"
            continue
        fi
        (cd "$folder" && PATH="$PWD/build/release/bin:$PATH" bash -eu -o pipefail "$block") >"$work/output" 2>&1 </dev/null ||
            fail "$guide:$line: exit code $?: $(cat "$block")
$(tail -n 15 "$work/output")"
    done <"$work/list"
}

for guide in "${guides[@]}"; do
    SECONDS=0
    run_guide "$guide"
    echo "$guide: $SECONDS s"
done
exit $((failures > 0))
