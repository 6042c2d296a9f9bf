# shellcheck shell=bash
# Helpers for the scripts of tests/cli. Each script begins with `. "$STOPLINE_SOURCE/tests/tools/cli.sh"` and ends with
# `exit $((failures > 0))`. $work is a temporary folder.

failures=0
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

# fail MESSAGE...: prints a failure and counts it
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# columns_of TABLE: prints the columns that scenarios/COLUMNS.md describes for the table, one per line
columns_of() {
    # shellcheck disable=SC2016 # the backticks are those of the page
    awk -v title="## $1" '/^## / { inside = $0 == title; next } inside && /^\| `/ { split($0, parts, "`"); print parts[2] }' \
        "$STOPLINE_SOURCE/scenarios/COLUMNS.md"
}

# expect_documented FILE TABLE [AXIS...]: expects scenarios/COLUMNS.md to describe every column of the CSV file, except
# each AXIS. CAPITALS in a described name stand for any word.
expect_documented() {
    local file=$1 table=$2 column
    shift 2
    [ -s "$file" ] || { fail "$table: $file is missing or empty"; return; }
    columns_of "$table" | sed -E 's/[.]/[.]/g; s/[A-Z]+/[A-Za-z0-9_.-]+/g' >"$work/documented"
    [ -s "$work/documented" ] || { fail "scenarios/COLUMNS.md has no table $table"; return; }
    printf '%s\n' "$@" >>"$work/documented"
    head -n 1 "$file" | tr ',' '\n' >"$work/columns"
    while read -r column; do
        grep -qxE -f "$work/documented" <<<"$column" || fail "$table: the column '$column' has no description in scenarios/COLUMNS.md"
    done <"$work/columns"
}

# wait_for COMMAND...: repeats COMMAND until it succeeds, for up to two minutes, so that tests do not depend on the
# machine's speed
wait_for() {
    local end=$((SECONDS + 120))
    until "$@" 2>/dev/null; do
        [ $SECONDS -lt $end ] || return 1
        sleep 0.05
    done
}

# machine_number: prints the number of this machine in the names of partial files: a hash (FNV-1a) of its name, the
# number of its start and the number of the container
machine_number() {
    python3 -c '
import os, pathlib, socket
start = pathlib.Path("/proc/sys/kernel/random/boot_id").read_text().strip()
number = 0x811c9dc5
for byte in (socket.gethostname() + start + os.readlink("/proc/self/ns/pid")).encode():
    number = (number ^ byte) * 0x01000193 & 0xffffffff
print(f"{number:08x}")'
}

# on_terminal PATTERN COMMAND...: runs COMMAND on a new terminal and interrupts it as soon as the terminal shows
# PATTERN. The terminal's text is in $work/typescript.
on_terminal() {
    local pattern=$1 words
    shift
    printf -v words '%q ' "$@"
    rm -f "$work/typescript" "$work/pid"
    script --quiet --flush --command "echo \$\$ >'$work/pid'; exec $words" "$work/typescript" </dev/null >/dev/null &
    local terminal=$!
    wait_for grep -qE "$pattern" "$work/typescript" || fail "the terminal does not show '$pattern'"
    kill -INT "$(cat "$work/pid")" 2>/dev/null
    wait $terminal
}
