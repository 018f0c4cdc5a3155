#!/bin/sh
# stack_depth.sh FOLDER LIMIT ROOT... [via:NAME...] [absent:NAME...]
# Worst-case stack of each ROOT function (part of its name) from the call graphs (*.ci) that the compiler left below
# FOLDER (-fcallgraph-info=su). Fails above LIMIT bytes, on recursion, on frames of unknown size and on a missing root.
# A call through a pointer may reach every function with a NAME of via: in its name; without via: such a call is an
# error. absent: names a weak function that is not defined and therefore never called. Control interrupt and background
# share the stack, so the depths of the roots and an exception frame each are added.
set -eu
folder=$1 limit=$2
shift 2
find "$folder" -name '*.ci' -exec cat {} + | awk -v limit="$limit" -v roots="$*" '
  function field(name,   rest) {
    rest = substr($0, index($0, name ": \"") + length(name) + 3)
    return substr(rest, 1, index(rest, "\"") - 1)
  }
  /^node:/ {
    title = field("title")
    if (match($0, /[0-9]+ bytes \([a-z,]+\)/)) {
      text = substr($0, RSTART, RLENGTH)
      bytes = text + 0
      if (!(title in frame) || bytes > frame[title]) frame[title] = bytes
      if (text ~ /dynamic/ && text !~ /bounded/) unbounded[title] = 1
      label[title] = field("label")
    }
  }
  /^edge:/ {
    source = field("sourcename"); target = field("targetname")
    if (!((source, target) in seen)) { seen[source, target] = 1; callee[source, ++callees[source]] = target }
  }
  # Library functions without a call graph: block operations and integer division, which use little or no stack.
  function is_library(f) { return f ~ /^(mem(cpy|set|move|cmp)|__aeabi_[a-z0-9_]+|__builtin_[a-z_]+|__popcountsi2)$/ }
  function complain(text) { print text > "/dev/stderr"; broken = 1 }
  function depth(f,   i, most, d) {
    if (f in known) return known[f]
    if ((is_library(f) || f in absent) && !(f in frame)) return known[f] = 0
    if (f == "__indirect_call") return known[f] = through_pointers()
    if (!(f in frame) && constructor_of_base(f) in frame) return known[f] = depth(constructor_of_base(f))
    if (!(f in frame)) complain("no call graph of " f)
    if (f in open) { complain("recursion through " f); return 0 }
    open[f] = 1
    if (f in unbounded) complain("frame of unknown size: " f)
    most = 0
    for (i = 1; i <= callees[f]; i++) { d = depth(callee[f, i]); if (d > most) most = d }
    delete open[f]
    return known[f] = most + frame[f]
  }
  # A constructor of a class without virtual bases has two names, and the call graph knows only one.
  function constructor_of_base(f) { sub(/C1E/, "C2E", f); return f }
  function through_pointers(   i, f, found, most, d) {
    most = 0
    for (i = 1; i <= pointed; i++) {
      found = 0
      for (f in frame) if (index(f, behind_pointer[i])) { found = 1; d = depth(f); if (d > most) most = d }
      if (!found) complain("no function " behind_pointer[i] " in the call graph")
    }
    if (!pointed) complain("a call through a pointer with unknown targets")
    return most
  }
  END {
    words = split(roots, word, " ")
    n = 0
    for (i = 1; i <= words; i++) {
      if (sub(/^via:/, "", word[i])) behind_pointer[++pointed] = word[i]
      else if (sub(/^absent:/, "", word[i])) absent[word[i]] = 1
      else wanted[++n] = word[i]
    }
    exception_frame = 108  # with FPU registers and alignment: ARMv7-M ARM, B1.5.7
    for (i = 1; i <= n; i++) {
      worst = -1
      for (f in frame) if (index(f, wanted[i])) { d = depth(f); if (d > worst) worst = d }
      if (worst < 0) { print "no function " wanted[i] " in the call graph" > "/dev/stderr"; exit 1 }
      printf "stack: %-24s %5d bytes\n", wanted[i], worst
      total += worst + (i > 1 ? exception_frame : 0)
    }
    printf "stack: worst case            %5d of %d bytes\n", total, limit
    exit broken || total > limit
  }'
