#!/bin/bash
# local_names_test.sh: the check reports only names that two sources of host, or of a folder of tests, define in anonymous
# namespaces.
set -euo pipefail
check=$(cd "$(dirname "$0")/../.." && pwd)/cmake/checks/local_names.py
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/host/record" "$tree/host/model" "$tree/sim"
fail() { echo "$1" >&2; exit 1; }

write() { # FOLDER/NAME LOCAL [PUBLIC]
  printf 'namespace host {\n\nnamespace {\n\n%s\n\n}  // namespace\n\n%s\n\n}  // namespace host\n' "$2" "${3:-}" > "$tree/host/$1.cpp"
}
accepts() { "$check" "$tree" 2> "$tree/said" || fail "$1, but the check says: $(cat "$tree/said")"; }
refuses() {
  ! "$check" "$tree" 2> "$tree/said" || fail "the check overlooks $1"
  grep -q "host/record/b.cpp: $1 is in host/model/a.cpp too" "$tree/said" || fail "the check does not name $1: $(cat "$tree/said")"
}

: > "$tree/host/CMakeLists.txt"
write model/a 'using Rows = std::vector<double>;
double scale_of(double value) {
  const double kHalf = 0.5;' 'double apart() {'
write record/b 'using Rows = std::vector<double>;
double scale_of(const Record& record) {
constexpr double kHalf = 0.5;
double apart() {'
accepts "aliases, overloads and names of other scopes may be the same"
for clash in 'struct Builder {' 'constexpr double kBuilder = 1.0;' 'enum class Builder { one };' \
  'std::vector<double> builder(const Record& record, double a) {' 'constexpr Named kBuilders[] = {' \
  '[[noreturn]] void builder(std::string_view name) {'; do
  write model/a "$clash"
  write record/b "$clash"
  refuses "$(grep -oiE 'k?builders?' <<< "$clash")"
done
echo 'set_source_files_properties(record/b.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)' > "$tree/host/CMakeLists.txt"
accepts "a source that is compiled by itself may take any name"
