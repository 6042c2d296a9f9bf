#!/usr/bin/env bash
# Installs missing Debian packages. If no package is missing, the script does nothing and needs no network.
#   apps/install_packages.sh SECTION...      sections of apps/packages.txt: quickstart, tests, python, sanitizers
# With STOPLINE_SKIP_PACKAGES=1 the script installs nothing. This is for systems on which the packages have other names.
set -euo pipefail

directory="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
list="$directory/packages.txt"
export LC_ALL=C.UTF-8

fail() {
    printf 'install_packages: %s\n' "$@" >&2
    exit 1
}

# section NAME: prints the packages in section NAME of packages.txt
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
    fail "no section given; the sections are in $list"
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
    fail "this is not a Debian system. Install the equivalents of these packages: ${wanted[*]}" \
        "Then run the script again with STOPLINE_SKIP_PACKAGES=1."
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
        as_root=(sudo) # sudo asks for the password
    else
        fail "packages are missing, and only root or sudo can install them. Run as root:" \
            "apt-get install --no-install-recommends ${missing[*]}"
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
    # Without Error-Mode=any, apt-get reports success although it could not fetch a package list.
    if apt_get update -o APT::Update::Error-Mode=any -qq >"$log" 2>&1; then
        break
    fi
    if [[ $attempt == 3 ]]; then
        # A single list that apt-get could not fetch counts as a failure. The other lists may suffice to install the
        # missing packages, so the script continues.
        echo "apt-get could not update the package lists and continues with the old ones. Its message:" >&2
        cat "$log" >&2
    else
        echo "apt-get update failed (attempt $attempt of 3); trying again in $((5 * attempt)) s" >&2
        sleep $((5 * attempt))
    fi
done
# The output of apt-get is long, so the script prints it only after a failure.
if ! apt_get install --yes --no-install-recommends "${missing[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    fail "apt-get could not install: ${missing[*]}" \
        "Its message is above. Common causes: no network, no mirror in /etc/apt, not Debian 12."
fi
