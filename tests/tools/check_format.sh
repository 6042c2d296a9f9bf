#!/usr/bin/env bash
# Checks the formatting of the C++ sources with clang-format. With --fix it formats them.
#   tests/tools/check_format.sh [--fix] [FILE...]       default: all files of core/, apps/ and tests/
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

# clang-format --dry-run names each place that it would change. Several processes check the files in turns.
findings="$(printf '%s\0' "${files[@]}" |
    xargs --null --max-args=8 --max-procs="$(nproc)" clang-format-14 --style=file --dry-run 2>&1 || true)"
# clang-format does not break long comments, and it does not see other languages.
mapfile -t commented < <(find core apps tests scenarios data CMakeLists.txt -type f \( -name '*.h' -o -name '*.inl' -o -name '*.cpp' \
    -o -name '*.js' -o -name '*.py' -o -name '*.sh' -o -name '*.yaml' -o -name CMakeLists.txt \) | sort)
if awk 'length > 120 && /^[[:space:]]*(\/\/|#|\*)|[^:"]\/\/ / && length > 120 {
        printf "%s:%d: a comment of %d columns; 120 is the limit\n", FILENAME, FNR, length; found = 1 }
        END { exit !found }' "${commented[@]}"; then
    exit 1
fi
if [[ -n $findings ]]; then
    head -40 <<<"$findings"
    echo "to format all files: tests/tools/check_format.sh --fix" >&2
    exit 1
fi
echo "${#files[@]} files are formatted"
