#!/usr/bin/env bash
# Tests that stopline-run compresses each output file whose name ends with .gz or .zst, and that the text is the same as
# that of the plain file. Two populations write two files of each kind. Other endings stay plain.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
data="$STOPLINE_SOURCE/tests/data"
cat >"$work/s.yaml" <<END
fidelity: meso
duration: 60 s
network: {kind: sumo, net: $data/left_turns.net.xml, routes: [$data/left_turns.rou.xml]}
populations: [CTG-Ref, CDG]
measure: {window: 60 s}
END

# run_with FOLDER ENDING: writes all output files into $work/FOLDER, with ENDING after their names
run_with() {
    mkdir "$work/$1"
    "$STOPLINE_BIN/stopline-run" "$work/s.yaml" --no-figures --output "$work/$1" --fcd "$work/$1/fcd.xml$2" \
        --tripinfo "$work/$1/trips.xml$2" --e1 "$work/$1/loops.xml$2" \
        --greens "$work/$1/greens.csv$2" --trajectories \
        --trajectories-file "trajectories.csv$2" >"$work/stdout" 2>"$work/stderr" ||
        fail "$1: exit code $?: $(head -c 300 "$work/stderr")"
}
run_with plain ""
run_with compressed ".gz"

# without_names FILE: prints FILE without the lines that name the output folder, which differs between the two runs, and
# without comments, which hold the command line
without_names() { grep -v -e '<!--' -e "$work" "$1"; }

for name in {fcd,trips,loops}.{CTG-Ref,CDG}.xml {greens,trajectories}.{CTG-Ref,CDG}.csv; do
    [ -s "$work/plain/$name" ] || fail "$name is missing or empty: $(ls "$work/plain")"
    gzip -t "$work/compressed/$name.gz" || fail "$name.gz is not compressed: $(ls "$work/compressed")"
    gzip -dc "$work/compressed/$name.gz" >"$work/text"
    cmp -s <(without_names "$work/plain/$name") <(without_names "$work/text") || fail "$name.gz has another text"
    [ -e "$work/compressed/$name" ] && fail "$name is there as well as $name.gz"
    gzip -t "$work/plain/$name" 2>"$work/stderr" && fail "$name is compressed"
done

# Zstandard: the test skips the comparison of the text if no program can decompress it.
run_with zstd ".zst"
for name in {fcd,trips,loops}.{CTG-Ref,CDG}.xml {greens,trajectories}.{CTG-Ref,CDG}.csv; do
    [ "$(head -c 4 "$work/zstd/$name.zst" | od -An -tx1 | tr -d ' ')" = 28b52ffd ] || fail "$name.zst is not compressed"
    [ -e "$work/zstd/$name" ] && fail "$name is there as well as $name.zst"
    command -v zstd >/dev/null || continue
    zstd -qdc "$work/zstd/$name.zst" >"$work/text" || fail "$name.zst is damaged"
    cmp -s <(without_names "$work/plain/$name") <(without_names "$work/text") || fail "$name.zst has another text"
done

exit $((failures > 0))
