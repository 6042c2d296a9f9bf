# shellcheck shell=bash
# What every script of tests/cli begins with: `. "$STOPLINE_SOURCE/tests/tools/cli.sh"`. It ends with `exit $((failures > 0))`.

failures=0
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# columns_of TABLE: the columns of the table in scenarios/COLUMNS.md, one a line
columns_of() {
    # shellcheck disable=SC2016 # the backticks are those of the page
    awk -v title="## $1" '/^## / { inside = $0 == title; next } inside && /^\| `/ { split($0, parts, "`"); print parts[2] }' \
        "$STOPLINE_SOURCE/scenarios/COLUMNS.md"
}

# expect_documented FILE TABLE [AXIS...]: every column of the CSV file is in the table in scenarios/COLUMNS.md, or an AXIS.
# CAPITALS in a documented name stand for any word.
expect_documented() {
    local file=$1 table=$2 column
    shift 2
    [ -s "$file" ] || { fail "$table: no file $file"; return; }
    columns_of "$table" | sed -E 's/[.]/[.]/g; s/[A-Z]+/[A-Za-z0-9_.-]+/g' >"$work/documented"
    [ -s "$work/documented" ] || { fail "scenarios/COLUMNS.md has no table $table"; return; }
    printf '%s\n' "$@" >>"$work/documented"
    head -n 1 "$file" | tr ',' '\n' >"$work/columns"
    while read -r column; do
        grep -qxE -f "$work/documented" <<<"$column" || fail "$table: the column '$column' has no description in scenarios/COLUMNS.md"
    done <"$work/columns"
}

# wait_for COMMAND...: until it succeeds, for up to two minutes, so that no test depends on how fast the machine is
wait_for() {
    local end=$((SECONDS + 120))
    until "$@" 2>/dev/null; do
        [ $SECONDS -lt $end ] || return 1
        sleep 0.05
    done
}

# on_terminal PATTERN COMMAND...: runs it on a terminal of its own, and interrupts it once the terminal shows PATTERN. What
# was shown is in $work/typescript.
on_terminal() {
    local pattern=$1 words
    shift
    printf -v words '%q ' "$@"
    rm -f "$work/typescript" "$work/pid"
    script --quiet --flush --command "echo \$\$ >'$work/pid'; exec $words" "$work/typescript" </dev/null >/dev/null &
    local terminal=$!
    wait_for grep -qE "$pattern" "$work/typescript" || fail "the terminal never shows '$pattern'"
    kill -INT "$(cat "$work/pid")" 2>/dev/null
    wait $terminal
}
