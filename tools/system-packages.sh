#!/bin/sh
# The system libraries that wheels do not bring: name what is missing in one line, or install it
# when that is allowed (as root, or in CI with sudo). Nothing to do on macOS.
# usage: system-packages.sh window|test [PYTHON]
set -eu
purpose=$1
python=${2:-python3}

fail() {
    echo "crossview: $*" >&2
    exit 1
}

command -v "$python" >/dev/null 2>&1 || fail "no $python found: install Python 3.11 or later, or run make PYTHON=/path/to/python3"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
    fail "$("$python" --version) is too old: crossview needs Python 3.11 or later (make PYTHON=python3.12)"
[ "$(uname)" = Linux ] || exit 0

missing=
libraries=$(PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null || true)
need_library() { # library, Debian package
    case "$libraries" in *"$1 "*) ;; *) missing="$missing $2" ;; esac
}
need_command() { # command, Debian package
    command -v "$1" >/dev/null 2>&1 || missing="$missing $2"
}

"$python" -c 'import ensurepip, venv' 2>/dev/null || missing="$missing python3-venv"

# off-screen rendering
need_library libEGL.so.1 libegl1
set -- /usr/lib/*/dri/*_dri.so /usr/lib/dri/*_dri.so /usr/lib64/dri/*_dri.so
found=
for driver in "$@"; do [ -e "$driver" ] && found=yes; done
[ -n "$found" ] || missing="$missing libgl1-mesa-dri"

# Qt, and a real window
need_library libGL.so.1 libgl1
need_library libxkbcommon.so.0 libxkbcommon0
need_library libdbus-1.so.3 libdbus-1-3
need_library libfontconfig.so.1 libfontconfig1
need_library libglib-2.0.so.0 libglib2.0-0
if [ "$purpose" = test ] || [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    need_library libxcb-cursor.so.0 libxcb-cursor0
    need_library libxcb-icccm.so.4 libxcb-icccm4
    need_library libxcb-keysyms.so.1 libxcb-keysyms1
    need_library libxcb-shape.so.0 libxcb-shape0
    need_library libxkbcommon-x11.so.0 libxkbcommon-x11-0
fi
if [ "$purpose" = test ]; then
    need_command Xvfb xvfb
    need_command xauth xauth
    need_command desktop-file-validate desktop-file-utils
fi

[ -n "$missing" ] || exit 0
command -v apt-get >/dev/null 2>&1 ||
    fail "these system packages (Debian names) are missing, install them with your package manager:$missing"

if [ "$(id -u)" = 0 ]; then
    as_root=
elif [ "${CI:-}" = true ] && sudo -n true 2>/dev/null; then
    as_root="sudo -n"
else
    fail "system packages are missing, install them with: sudo apt-get update && sudo apt-get install -y --no-install-recommends$missing"
fi
echo "crossview: installing system packages:$missing"
$as_root apt-get update -qq || true # an old package list may still do
# shellcheck disable=SC2086
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing </dev/null >/dev/null ||
    fail "apt-get could not install:$missing"
