// Plans, runs and decides on the public cases whose group motion or a hand must split, and prints the table.
#include <fmt/format.h>

#include "tests/host/plan/plan_trial.hpp"

int main(int count, char** words) {
  if (count < 2) {
    fmt::print(stderr, "usage: {} FOLDER [CASE …]   (FOLDER: of the public cases, with single/)\n", words[0]);
    return 2;
  }
  return print_plan_bench(words[1], {words + 2, words + count}) ? 0 : 1;
}
