#!/bin/bash
# package_test.sh: the Python package installs from a copy of its folder with Debian's pip and this build tree's module.
# Without a project or a build tree it says so. Its types pass mypy --strict, and its stub matches the module.
set -euo pipefail
python=/usr/bin/python3
$python -c 'import numpy, setuptools, pip' 2> /dev/null || { echo "python3-numpy, -setuptools or -pip is missing" >&2; exit 77; }
project=$(cd "$(dirname "$0")/../../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -a "$project/host/python" "$folder/source"
: "${AXIS_BUILD:?names the build tree}"
if (cd "$folder/source" && AXIS_BUILD= $python setup.py -q build_ext > "$folder/log" 2>&1) ||
  ! grep -q 'own folder host/python' "$folder/log"; then
  echo "without the project it does not say what is wrong:" >&2; cat "$folder/log" >&2; exit 1
fi
PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore $python -m pip install --quiet --no-build-isolation --no-deps \
  --no-index --target "$folder/site" "$folder/source"
test -f "$folder/site/axistool/py.typed" -a -f "$folder/site/axistool/_host.pyi"
cd "$folder"
PYTHONPATH=$folder/site $python - << 'EOF'
import ast
import axistool._host as module
stub = ast.parse(open(module.__file__.split("_host.")[0] + "_host.pyi").read())
told = {one.name for one in stub.body if isinstance(one, (ast.FunctionDef, ast.ClassDef))}
held = {name for name, one in vars(module).items() if callable(one)}
assert told == held, f"_host.pyi and the module differ in {told ^ held}"
EOF
if command -v mypy > /dev/null; then mypy --strict --no-error-summary --cache-dir "$folder/cache" "$folder/site/axistool"; fi
