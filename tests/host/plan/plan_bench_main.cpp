// Plans, runs and decides on machines of independent code, and prints the table: the public cases of each group that a
// motion or a manual test must separate, and the same machines with another member of the group.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "tests/host/plan/plan_trial.hpp"

namespace {

std::vector<PlanTrial> trials_of(const std::filesystem::path& folder, const std::vector<std::string>& chosen) {
  std::vector<PlanTrial> trials;
  for (const char* name : {"case-03", "case-04", "case-05", "case-06", "case-07", "case-09", "case-11", "case-12"}) {
    const std::filesystem::path place = folder / "single" / name;
    if (!std::filesystem::exists(place) || (!chosen.empty() && std::ranges::find(chosen, name) == chosen.end()))
      continue;
    const PlanTrial trial = public_trial(place);
    trials.push_back(trial);
    const std::string known(name);
    if (known == "case-06") {
      for (const double delay_s : {0.001, 0.002}) trials.push_back(with_delay(trial, delay_s));
      for (const double bandwidth_Hz : {150.0, 80.0}) trials.push_back(with_lag(trial, bandwidth_Hz));
      trials.push_back(with_level(trial, "dac_offset", 0.15));
    }
    if (known == "case-09") trials.push_back(with_load_dependent_friction(trial));
    if (known == "case-12")
      for (const char* truth : {"coulomb_asymmetry", "dac_offset"}) trials.push_back(with_level(trial, truth, 0.15));
  }
  return trials;
}

/// RMS difference between the speeds in the record of the case and for the same commands here, relative to that of two
/// noises. It is about 1 if this plant equals that of the case.
double likeness(const PlanTrial& trial) {
  const host::Record &own = trial.training.front(), again = replayed(trial.drive, own);
  double square = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) square += (again.w[k] - own.w[k]) * (again.w[k] - own.w[k]);
  return std::sqrt(square / static_cast<double>(own.size()) / (2.0 * trial.drive.tach_variance));
}

constexpr double kMostOfJogs = 1.0 / 3.0;  // largest part of the jogs' duration for a planned run

/// Prints a line for each pair that contains the truth. Returns false if a separable pair was decided wrongly, if the
/// odds are wrong by more than a factor of three, or if the run took more than a third of the time of the fixed jogs.
bool print(const PlanTrial& trial, const TrialOutcome& outcome) {
  const double share = outcome.recorded_s / trial.jogs_s;
  bool good = (!outcome.plan.separable || outcome.completed) && share <= kMostOfJogs;
  for (const PairOutcome& pair : outcome.pairs) {
    const bool within = pair.came <= 3.0 * pair.expected && pair.expected <= 3.0 * pair.came;
    const bool right = pair.separable ? pair.right && within : pair.by_hand;
    good = good && right;
    fmt::print("{:<18} {:<18} {:<24} {:>8.4g} {:>8.4g}  {:<8} {:5.1f} {:5.2f} {:5.2f} {:5.2f} {:6.1f}{}\n", trial.name,
               pair.a, pair.b, pair.expected, pair.came, pair.separable ? (pair.right ? "right" : "WRONG") : "by hand",
               outcome.recorded_s, share, outcome.error, likeness(trial), outcome.computed_s, right ? "" : "  <-");
  }
  for (const host::RunPiece& piece : outcome.plan.run.pieces) fmt::print("    {}\n", host::piece_text(piece));
  std::fflush(stdout);
  return good;
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) {
    fmt::print(stderr, "usage: {} FOLDER [CASE …]   (FOLDER: of the cases, with single/)\n", words[0]);
    return 2;
  }
  fmt::print("{:<18} {:<18} {:<24} {:>8} {:>8}  {:<8} {:>5} {:>5} {:>5} {:>5} {:>6}\n", "machine", "true", "rival",
             "expected", "came", "answer", "run s", "jogs", "error", "alike", "CPU s");
  bool good = true;
  for (const PlanTrial& trial : trials_of(words[1], {words + 2, words + count}))
    good = print(trial, carried_out(trial)) && good;
  return good ? 0 : 1;
}
