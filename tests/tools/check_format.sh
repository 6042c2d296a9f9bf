#!/usr/bin/env bash
# Checks that clang-format would change nothing; with --fix it changes it.
#   tests/tools/check_format.sh [--fix] [FILE...]       default: all of core/, apps/ and tests/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

fix=no
if [[ "${1:-}" == --fix ]]; then
    fix=yes
    shift
fi
files=("$@")
if [[ ${#files[@]} -eq 0 ]]; then
    mapfile -t files < <(find core apps tests \( -name '*.h' -o -name '*.inl' -o -name '*.cpp' \) -type f | sort)
fi
if [[ $fix == yes ]]; then
    exec clang-format-14 --style=file -i "${files[@]}"
fi

unformatted=()
for file in "${files[@]}"; do
    if ! difference="$(clang-format-14 --style=file "$file" | diff --unified=0 --label "$file" --label formatted "$file" -)"; then
        unformatted+=("$file")
        head -20 <<<"$difference"
    fi
done
if [[ ${#unformatted[@]} -gt 0 ]]; then
    echo "to put this right: tests/tools/check_format.sh --fix ${unformatted[*]}" >&2
    exit 1
fi
echo "${#files[@]} files"
