#!/bin/sh
# documents.sh AXISTOOL FOLDER PROJECT VERSION: manual, completions, udev rule, changelog and licence as packages have them.
set -eu
axistool=$1
folder=$2
project=$3
version=$4

mkdir -p "$folder"
"$axistool" man "$folder/man1"
gzip -9n "$folder"/man1/*.1
for shell in bash zsh fish; do
  "$axistool" completion "$shell" > "$folder/axistool.$shell"
done
"$axistool" udev-rule > "$folder/70-axis.rules"

# .github/CHANGELOG.md in Debian's form: "## VERSION, DATE" begins a version, "- " an entry, whose further lines are
# indented.
maintainer='The axis maintainers <maintainers@axis.invalid>'
awk -v maintainer="$maintainer" '
  function entry(  words, count, k, line) {
    count = split(text, words, " ")
    line = count ? "  *" : ""
    for (k = 1; k <= count; ++k) {
      if (length(line " " words[k]) > 78) { print line; line = "   " }
      line = line " " words[k]
    }
    if (count) print line
    text = ""
  }
  function finish() { entry(); if (date != "") print "\n -- " maintainer "  " date "\n" }
  /^## / {
    finish()
    split(substr($0, 4), part, ", ")
    ("LC_ALL=C date -u -R -d " part[2]) | getline date
    print "axistool (" part[1] ") unstable; urgency=medium\n"
  }
  date != "" && /^- /     { entry(); text = substr($0, 3) }
  date != "" && /^  [^ ]/ { text = text " " substr($0, 3) }
  END { finish() }' "$project/.github/CHANGELOG.md" > "$folder/changelog"
grep -q "^axistool ($version)" "$folder/changelog" || {
  echo "$project/.github/CHANGELOG.md: begins no version $version: add \"## $version, DATE\"" >&2
  exit 1
}
gzip -9n "$folder/changelog"

{
  printf 'Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: axis\n\n'
  printf 'Files: *\nCopyright: %s\nLicense: Expat\n' "$(sed -n 's/^Copyright (c) //p' "$project/LICENSE")"
  sed -n '/^Permission/,$p' "$project/LICENSE" | sed -e 's/^$/./' -e 's/^/ /'
} > "$folder/copyright"
