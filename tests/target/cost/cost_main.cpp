// axis_cost: the instructions of one control step, in each number type and on each processor, as a table.
#include <fmt/format.h>

#include <cstdio>

#include "firmware/core/excitation/excitation_plan.hpp"
#include "tests/target/cost/cost.hpp"
#include "tests/target/qemu.hpp"

namespace {

using target_test::count_instructions;
using target_test::obstacle;

constexpr double kClock_Hz = 168e6;
constexpr double kFastest_Hz = 20e3;

struct Row {
  const char* image;
  const char* text;
};
constexpr Row kLaws[] = {
    {"cost-float-m4", "float, Cortex-M4F"},         {"cost-fixed-m4", "fixed point, Cortex-M4"},
    {"cost-fixed-m3", "fixed point, Cortex-M3"},    {"cost-fixed-m0plus", "fixed point, Cortex-M0+"},
    {"cost-float-m3", "software float, Cortex-M3"}, {"cost-float-m0plus", "software float, Cortex-M0+"},
    {"cost-double-m4", "double, Cortex-M4F"},
};

void print_laws() {
  fmt::print("Executed instructions a control step (mean, worst of 1500 with moves, jogs and reversals)\n\n");
  fmt::print("{:<28}{:>24}{:>16}{:>16}\n", "", "estimator + feedback", "one axis", "both axes");
  for (const Row& row : kLaws) {
    auto costs = count_instructions(row.image);
    fmt::print("{:<28}", row.text);
    for (const char* part : {"estimator_and_feedback", "one_axis", "both_axes"})
      fmt::print("{:>{}} {:>6}", costs[part].mean, part[0] == 'e' ? 17 : 9, costs[part].worst);
    fmt::print("\n");
    if (&row == &kLaws[0]) {
      const double share = costs["both_axes"].worst * kFastest_Hz / kClock_Hz;
      fmt::print("{:<28}both axes at 20 kHz: {:.1f} % of 168 million instructions a second\n", "", 100.0 * share);
      fmt::print("{:<28}both axes, x excited by {} lines: {}, {} at worst; a captured row of four channels: {}, {}\n",
                 "", firmware::kExcitationEntries, costs["both_axes_excited"].mean, costs["both_axes_excited"].worst,
                 costs["captured_row"].mean, costs["captured_row"].worst);
      fmt::print("{:<28}both axes on a path: {}, {} at worst\n", "", costs["both_axes_on_path"].mean,
                 costs["both_axes_on_path"].worst);
      fmt::print("{:<28}x excited while y is on a path: {}, {} at worst\n", "", costs["excited_and_on_path"].mean,
                 costs["excited_and_on_path"].worst);
    }
  }
}

void print_background() {
  auto costs = count_instructions("shut-out-m4");
  fmt::print(
      "\nThe background's watches of process force and friction feed-forward, both axes, a control period: {}, {} at "
      "worst\n",
      costs["watches"].mean, costs["watches"].worst);
}

void print_other_ways() {
  fmt::print("\nEstimator and feedback written in other ways, float, Cortex-M4F\n");
  auto costs = count_instructions("cost-matrix-m4");
  fmt::print("{:<28}{:>17} {:>6}\n", "Eigen, fixed sizes", costs["eigen"].mean, costs["eigen"].worst);
  fmt::print("{:<28}{:>17} {:>6}\n", "general matrix functions", costs["general_matrices"].mean,
             costs["general_matrices"].worst);
}

}  // namespace

int main() {
  const std::string why = obstacle("cost-float-m4");
  if (!why.empty()) {
    fmt::print(stderr, "{}\n", why);
    return 77;
  }
  try {
    print_laws();
    print_background();
    print_other_ways();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
