#!/usr/bin/env bash
# Checks the project's shell scripts with shellcheck.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

mapfile -t files < <(find apps tests .ci -type f \( -name '*.sh' -o -path .ci/run \) | sort)
shellcheck --shell=bash "${files[@]}"
echo "${#files[@]} scripts are clean"
