#!/bin/bash
# package_test.sh: the Python package installs from a copy of its folder by Debian's own pip, needs nothing else, and its
# types hold under mypy --strict.
set -euo pipefail
python=/usr/bin/python3
$python -c 'import numpy, setuptools, pip' 2> /dev/null || { echo "python3-numpy, -setuptools or -pip is missing" >&2; exit 77; }
project=$(cd "$(dirname "$0")/../../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -r "$project/host/python" "$folder/source"
PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore $python -m pip install --quiet --no-build-isolation --no-deps \
  --no-index --target "$folder/site" "$folder/source"
test -f "$folder/site/axistool/py.typed"
cd "$folder" && PYTHONPATH=$folder/site $python -c 'import axistool; axistool.Record'
if command -v mypy > /dev/null; then mypy --strict --no-error-summary --cache-dir "$folder/cache" "$project/host/python/axistool"; fi
