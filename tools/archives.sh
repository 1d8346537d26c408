#!/bin/sh
# Make the wheel and the sdist in dist/, and see that they pass their tests away from here: the
# sdist is unpacked, the wheel installed into an environment of its own, and the tests of the one
# run on the other.
# usage: archives.sh PYTHON [what pytest is to do; all tests if nothing is said]
set -eu
python=$1
shift
[ $# -gt 0 ] || set -- -n auto
cd "$(dirname "$0")/.."
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
"$python" -m pip --disable-pip-version-check install --quiet build
rm -rf dist
"$python" -m build --outdir dist . >/dev/null
"$python" -m venv "$place/venv"
"$place/venv/bin/python" -m pip --disable-pip-version-check install --quiet "$(echo dist/*.whl)[test]"
tar -xzf dist/*.tar.gz -C "$place" --strip-components=1 --one-top-level=sources
cd "$place/sources"
# what is tested is the wheel
rm -rf crossview solvers crossview_program.py
OPENBLAS_NUM_THREADS=1 "$place/venv/bin/python" -m pytest "$@"
