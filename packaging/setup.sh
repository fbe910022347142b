#!/bin/sh
# Prepares this checkout: `packaging/setup.sh run` for the program, `test` for its tests, `package` for building it.
# It can be repeated at any time: what is ready is left alone, what an interrupted run left half done is done again.
set -eu
cd "$(dirname "$0")/.."

WINDOW_LIBRARIES="libegl1 libgl1 libglib2.0-0 libdbus-1-3 libfontconfig1 libxkbcommon0
    libxkbcommon-x11-0 libxcb-cursor0 libxcb-icccm4 libxcb-keysyms1 libxcb-shape0"
VIRTUAL_DISPLAY="xvfb xauth"
BUILDING="binutils zstd dpkg"

say() { printf 'busk: %s\n' "$@" >&2; }
fail() { say "$@"; exit 1; }

find_python() {
    for name in ${PYTHON:-python3 python3.13 python3.12 python3.11}; do
        if "$name" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' 2>/dev/null; then
            command -v "$name"
            return
        fi
    done
    fail "Busk needs Python 3.11, 3.12 or 3.13; ${PYTHON:-python3} is: $("${PYTHON:-python3}" --version 2>&1 || true)" \
        "Install one of them (Debian and Ubuntu: apt-get install python3.12 python3.12-venv) and call make again." \
        "A Python in another place can be named: make setup PYTHON=/opt/python3.12/bin/python3"
}

# Newer releases rename some libraries with the suffix t64 (libglib2.0-0t64); apt-get accepts the old name.
is_installed() {
    dpkg-query -W -f='${db:Status-Status}\n' "$1" "$1t64" 2>/dev/null | grep -qx installed
}

wanted_packages() {
    echo $WINDOW_LIBRARIES
    case "$level" in
        test) echo $VIRTUAL_DISPLAY ;;
        package) echo $BUILDING ;;
    esac
}

missing_packages() {
    for name in $(wanted_packages); do
        is_installed "$name" || printf '%s ' "$name"
    done
    if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
        "$python" -c 'import sys; print("python3.%d-venv" % sys.version_info[1])'
    fi
}

install_packages() {
    if [ "$(id -u)" = 0 ]; then
        as_root=
    elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
        as_root=sudo
        say "sudo may ask for your password, to install: $*"
    else
        fail "These system packages are missing: $*" \
            "Installing them needs an administrator, who can run this line:" "" \
            "    apt-get update && apt-get install -y --no-install-recommends $*" "" \
            "Call make again afterwards; it needs no further rights."
    fi
    apt="$as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=120"
    say "Installing system packages: $*"
    $apt update >&2 || say "apt-get update failed; going on with the package lists that are here."
    $apt install -y --no-install-recommends "$@" >&2 || fail "apt-get could not install: $*" "Its reason stands above."
}

prepare_system() {
    if command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; then
        packages=$(missing_packages)
        # shellcheck disable=SC2086  # one word a package
        [ -z "$packages" ] || install_packages $packages
    elif [ "$(uname)" = Linux ]; then
        say "This system has no apt-get, so its libraries are not checked. Busk needs what Debian calls:" \
            "$(wanted_packages)"
    fi
}

# A complete environment knows its pip, and that pip knows the place where it lies (a moved checkout starts afresh).
is_environment() {
    case "$(.venv/bin/pip --version 2>/dev/null)" in
        *" $(pwd -P)/.venv/"*"(python 3.1"[123]")") return 0 ;;
    esac
    return 1
}

prepare_environment() {
    if ! is_environment; then
        rm -rf .venv
        "$python" -m venv .venv || fail "Python could not create its environment in .venv; its reason stands above."
    fi
    say "Installing the Python packages into .venv (some hundred megabytes the first time)"
    pip=".venv/bin/python -m pip --disable-pip-version-check --no-input --timeout 60 $([ -t 1 ] || echo --quiet)"
    $pip install --only-binary :all: --require-hashes -r requirements.lock ||
        fail "The Python packages could not be installed; the reason stands above." "Call make again to go on from here."
    $pip install --no-index --no-deps --no-build-isolation --editable .
    # Compiled once here, the loops are only read later; without them the program works too, only slower.
    .venv/bin/python -c "from core.geometry import kernels; kernels.warm()" || true
}

is_ready() {
    [ -x .venv/bin/python ] && [ -x .venv/bin/busk ] && [ "$(cat ".venv/.ready-$1" 2>/dev/null)" = "$key" ]
}

level=${1:-run}
key=$(cat requirements.lock pyproject.toml packaging/setup.sh | cksum; pwd -P)
if ! is_ready "$level"; then
    python=$(find_python)
    prepare_system
    is_ready run || prepare_environment
    printf '%s\n' "$key" | tee .venv/.ready-run > ".venv/.ready-$level"
    say "Ready."
fi
