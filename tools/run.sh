#!/bin/sh
# Show a case: in the window where there is a display, else as a picture.
# usage: run.sh CROSSVIEW CASE PICTURE
set -eu
if [ "$(uname)" = Darwin ] || [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    exec "$1" "$2"
fi
"$1" render "$2" -o "$3"
echo "No display here: $2 is rendered to $(pwd)/$3"
