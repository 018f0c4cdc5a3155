#!/bin/sh
# Fails when an include of the tree $1 breaks the rules of which folder may include which. Headers of this project are
# included in quotes, by the path from the root.
set -eu
cd "$1"
find firmware hal host sim tests -type f \( -name '*.[ch]pp' -o -name '*.[chS]' \) 2>/dev/null | LC_ALL=C sort | awk '
  # The longest folder that matches the including file decides; the value lists the folders that it may include.
  BEGIN {
    may["hal/"] = "hal/"
    may["hal/pc/"] = "hal/ sim/"
    may["firmware/core/"] = "hal/ firmware/core/"
    may["firmware/app/"] = "hal/ firmware/core/ firmware/app/"
    may["firmware/boards/"] = "hal/ firmware/"
    may["firmware/boards/pc/"] = "hal/ firmware/ sim/"
    may["sim/"] = "sim/"
    may["host/"] = "host/ sim/ hal/ firmware/core/ firmware/app/"
    may["host/record/"] = "host/record/ sim/"
    may["host/import/"] = "host/import/ host/record/ sim/ firmware/app/"
    may["host/opening/"] = "host/opening/ host/import/ host/record/ sim/"
    may["host/model/"] = "host/model/ sim/"
    may["host/report/"] = "host/report/ host/model/ sim/"
    may["host/identify/"] = "host/identify/ host/record/ sim/"
    may["host/evidence/"] = "host/evidence/ " may["host/identify/"]
    may["host/compare/"] = "host/compare/ host/report/ host/scale/ " may["host/evidence/"]
    may["host/interchange/"] = "host/interchange/ " may["host/compare/"]
    may["host/infer/"] = "host/infer/"
    may["host/scale/"] = "host/scale/ host/infer/ host/report/ " may["host/evidence/"]
    may["host/effort/"] = "host/effort/ host/infer/ " may["host/compare/"]
    may["host/fit/"] = "host/fit/ " may["host/compare/"]
    may["host/search/"] = "host/search/ host/fit/ " may["host/effort/"]
    may["host/diagnose/"] = "host/diagnose/ host/search/ host/fit/ host/scale/ " may["host/effort/"]
    may["host/scoreboard/"] = "host/scoreboard/ host/model/ " may["host/diagnose/"]
    may["host/parameters/"] = "host/parameters/ host/identify/ sim/ firmware/core/ firmware/app/"
    may["host/path/"] = "host/path/ firmware/core/"
    may["host/gcode/"] = "host/gcode/ host/path/"
    may["host/link/"] = "host/link/ hal/"
    may["host/simulated_board/"] = "host/simulated_board/ host/link/ sim/ hal/ firmware/core/ firmware/app/"
    may["host/device/"] = "host/device/ host/path/ host/link/ host/parameters/ host/record/ sim/ hal/ firmware/core/ firmware/app/"
    may["host/live/"] = "host/live/ " may["host/device/"]
    may["host/workbench/"] = "host/workbench/ host/commission/ host/model/ host/opening/ host/response/ host/hil/ " may["host/live/"] " " may["host/diagnose/"]
    may["host/external_plant/"] = "host/external_plant/ host/record/ sim/"
    may["host/response/"] = "host/response/ host/model/ host/report/ " may["host/device/"] " " may["host/identify/"]
    may["host/axes/"] = "host/axes/ host/infer/ " may["host/response/"]
    may["host/plan/"] = "host/plan/ host/device/ host/parameters/ hal/ firmware/core/ firmware/app/ " may["host/diagnose/"]
    may["host/axistool/"] = "host/ host/axistool/ sim/ hal/ firmware/core/ firmware/app/"
    may["tests/"] = "tests/ host/ host/axistool/ sim/ hal/ firmware/"

    # The standard headers that the microcontroller build allows: nothing that allocates, throws or does I/O.
    count = split("algorithm array atomic bit climits cmath compare concepts cstddef cstdint cstring initializer_list " \
                  "iterator limits numbers numeric optional ratio span string_view tuple type_traits utility variant version", names)
    for (i = 1; i <= count; i++) freestanding[names[i]] = 1
  }

  function longest_rule(path,   folder, best) {
    best = ""
    for (folder in may) if (index(path, folder) == 1 && length(folder) > length(best)) best = folder
    return best
  }

  function allowed(rule, header,   folders, n, i) {
    if (index(header, "host/axistool/") == 1) return index(may[rule], "host/axistool/") > 0
    if (rule ~ /^host\// && header ~ /^host\/[^\/]*$/) return 1
    n = split(may[rule], folders, " ")
    for (i = 1; i <= n; i++) if (index(header, folders[i]) == 1) return 1
    return 0
  }

  function complain(text) {
    printf "%s:%d: %s\n", path, line_number, text
    broken = 1
  }

  function check(header, quoted,   rule) {
    rule = longest_rule(path)
    if (header ~ /^(firmware|hal|host|sim|tests)\//) {
      if (!quoted) complain("include of <" header ">: our own headers stand in quotes")
      else if (!allowed(rule, header)) complain(rule " may not include \"" header "\"")
    } else if (header == "fftw3.h" && path != "host/fourier.cpp") {
      complain("include of <fftw3.h>: its planner is not re-entrant; call host/fourier.hpp, which locks it")
    } else if (quoted) {
      complain("include of \"" header "\": write the path from the root of the project")
    } else if (rule == "firmware/core/" && !(header in freestanding)) {
      complain("firmware/core/ may not include <" header ">: it is not in the freestanding part that the target has")
    }
  }

  {
    path = $0
    line_number = 0
    while ((getline line < path) > 0) {
      line_number++
      if (line !~ /^[ \t]*#[ \t]*include[ \t]*[<"]/) continue
      quoted = line ~ /include[ \t]*"/
      sub(/^[^<"]*[<"]/, "", line)
      sub(/[>"].*$/, "", line)
      check(line, quoted)
    }
    close(path)
    files++
  }
  END {
    if (!files) { print "include rules: no source file found"; exit 2 }
    exit broken
  }'
