# shellcheck shell=bash
# What every script of tests/cli begins with: `. "$STOPLINE_SOURCE/tests/tools/cli.sh"`. It ends with `exit $((failures > 0))`.

failures=0
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
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
