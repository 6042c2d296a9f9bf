#!/usr/bin/env bash
# Puts a clang-tidy three times as fast as Debian 12's (which spends its time in system headers) into build/clang-tidy, from the
# Python package index. When that can't be done, says so and goes on: lint.py then uses Debian's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

version=22.1.8
folder=build/clang-tidy
if [[ "$("$folder/bin/clang-tidy" --version 2>/dev/null)" == *"version $version"* ]]; then
    exit 0
fi
rm -rf "$folder"
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
if ! { python3 -m venv "$folder" && "$folder/bin/pip" install --quiet --disable-pip-version-check "clang-tidy==$version" &&
    "$folder/bin/clang-tidy" --version; } >"$log" 2>&1; then
    rm -rf "$folder"
    echo "clang-tidy $version can't be installed (the lint check takes three times as long with Debian's): $(tail -n 1 "$log")" >&2
fi
