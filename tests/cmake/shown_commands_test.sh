#!/bin/bash
# shown_commands_test.sh: every command in the documentation exists with its options, and every make target and file
# that it names exists.
set -euo pipefail
project=$(cd "$(dirname "$0")/../.." && pwd)
axistool=${AXIS_BUILD:?names the build tree}/bin/axistool
cd "$project"
bad=0
complain() { echo "$1" >&2; bad=1; }

pages=(README.md .github/CONTRIBUTING.md host/examples/README.md host/examples/from-log-to-model.md
       host/examples/linuxcnc/README.md)
while IFS= read -r line; do
  read -ra words <<< "${line%%#*}"
  command=${words[0]:-}
  [[ $command =~ ^[a-z-]+$ && $command != --* ]] || continue
  help=$("$axistool" help "$command" 2> /dev/null) || { complain "axistool $command: no such command"; continue; }
  for word in "${words[@]}"; do
    [[ $word == --[a-z]* ]] || continue
    grep -q -- "${word%%[=\`;,.:)]*}\b" <<< "$help" || complain "axistool $command has no $word"
  done
done < <(grep -hoE '(^    |`|sudo |bin/)axistool [a-z][^`]*' "${pages[@]}" | sed 's/.*axistool //')

targets=$(make -s help)
while IFS= read -r target; do
  grep -qE "make $target( |$)" <<< "$targets" || complain "make $target: no such target"
done < <(grep -hoE '(^    |`)make [a-z][a-z-]*' "${pages[@]}" | sed 's/.*make //' | sort -u)

while IFS= read -r path; do
  case $path in *NAME* | *CHIP*) continue ;; esac
  test -e "$path" || complain "$path: no such file"
done < <(grep -hoE '`(firmware|hal|host|sim|tests|cmake)/[A-Za-z0-9_./-]+`' "${pages[@]}" | tr -d '`' | sort -u)
exit $bad
