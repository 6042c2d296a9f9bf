#!/usr/bin/env bash
# Installs the Debian packages that are missing; does nothing, and needs no network, when all are there.
#   apps/install_packages.sh SECTION...      sections of apps/packages.txt: quickstart, tests
# STOPLINE_SKIP_PACKAGES=1 turns it off, for systems that have the same things under other names.
set -euo pipefail

directory="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
list="$directory/packages.txt"
export LC_ALL=C.UTF-8

fail() {
    printf 'install_packages: %s\n' "$@" >&2
    exit 1
}

# The packages of one section of the list.
section() {
    local line current=""
    while read -r line; do
        case "$line" in
            "" | "#"*) ;;
            "["*) current="$line" ;;
            *) if [[ "$current" == "[$1]" ]]; then echo "$line"; fi ;;
        esac
    done <"$list"
}

is_installed() {
    dpkg-query --show --showformat='${db:Status-Status}\n' "$1" 2>/dev/null | grep --quiet --line-regexp installed
}

if [[ $# -eq 0 ]]; then
    fail "name at least one section of $list"
fi
wanted=()
for name in "$@"; do
    mapfile -t packages < <(section "$name")
    if [[ ${#packages[@]} -eq 0 ]]; then
        fail "no packages in section [$name] of $list"
    fi
    wanted+=("${packages[@]}")
done

if [[ "${STOPLINE_SKIP_PACKAGES:-}" == 1 ]]; then
    exit 0
fi
if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "this is not a Debian system, so install the equivalents of these packages yourself: ${wanted[*]}" \
        "then run again with STOPLINE_SKIP_PACKAGES=1"
fi

missing=()
for package in "${wanted[@]}"; do
    if ! is_installed "$package"; then
        missing+=("$package")
    fi
done
if [[ ${#missing[@]} -eq 0 ]]; then
    exit 0
fi

as_root=()
if [[ "$(id -u)" != 0 ]]; then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
        as_root=(sudo -n)
    elif command -v sudo >/dev/null && [[ -t 0 ]]; then
        as_root=(sudo) # asks for the password
    else
        fail "these packages are missing, and installing them takes root or sudo: ${missing[*]}" \
            "as root: apt-get install --no-install-recommends ${missing[*]}"
    fi
fi

apt_get() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 \
        apt-get -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@"
}

echo "Installing ${#missing[@]} missing packages: ${missing[*]}"
log="$(mktemp)"
trap 'rm -f "$log"' EXIT
for attempt in 1 2 3; do
    # Without Error-Mode=any a list that could not be fetched is only a warning.
    if apt_get update -o APT::Update::Error-Mode=any -qq >"$log" 2>&1; then
        break
    fi
    if [[ $attempt == 3 ]]; then
        # A mirror that has nothing to do with these packages may be the one that fails: let the installation decide.
        echo "The package lists could not be brought up to date; going on with those at hand. apt-get update says:" >&2
        cat "$log" >&2
    else
        echo "apt-get update failed (attempt $attempt of 3); trying again in $((5 * attempt)) s" >&2
        sleep $((5 * attempt))
    fi
done
# Its output is long and of interest only when it fails.
if ! apt_get install --yes --no-install-recommends "${missing[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    fail "apt-get could not install: ${missing[*]}" \
        "(no network, no mirror in /etc/apt, or not Debian 12? its own message is above)"
fi
