// Compares the diagnosis of a trial with the truth.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/scoreboard/trial.hpp"

namespace host {

/// Right: exactly the truth, or no claim if nothing is hidden or the hidden effect is in no catalogue. Group: an
/// ambiguous answer that contains the truth. Partly: some of several effects, and nothing else. Wrong: an effect that
/// is not present. Missed: no claim although there was an effect to find.
enum class Outcome { right, group, partly, wrong, missed };

std::string_view outcome_name(Outcome outcome);

Outcome outcome_of(const Truth& truth, const DiagnosisVerdict& verdict);

/// A stated probability, and whether it came true.
using Forecast = std::pair<double, bool>;

struct Answer {
  std::string name, group;
  Truth truth;
  DiagnosisVerdict verdict;
  double before = 0.0, after = 0.0;  ///< combined error on validation data
  double seconds = 0.0;
  Outcome outcome = Outcome::missed;
  std::vector<Forecast> forecasts;  ///< for every candidate, "nothing" and "something else"

  /// Part of the squared error above the noise floor that was removed; 0 if there was none.
  double explained() const;
  bool gives_all_clear() const { return verdict.status == Status::adequate || verdict.status == Status::parameters; }
};

/// Compares a diagnosis with the truth.
Answer answer_of(const std::string& name, const std::string& group, const Truth& truth, const Diagnosis& diagnosis,
                 double seconds);

/// Runs a trial on a case's model.
Answer run_trial(const Trial& trial, const ShareDone& progress = {});

/// Result of a diagnosis without the case's hidden effect in the catalogue.
struct LeftOut {
  bool right_coordinate = false;  ///< the coordinate of the hidden effect was named, or a related effect
  Answer answer;       ///< right: no name. Group: related effects only. Wrong: any other name, or an all-clear
  std::string over;    ///< coordinate of the best free curve in validation; empty if none lowers the error
  double curve = 0.0;  ///< part of the explainable squared error that it removes, 0..1
};

/// Runs a whole case with its effects declared absent.
LeftOut leave_out(const Trial& trial, const ShareDone& progress = {});

/// Diagnoses a simulated drive in which nothing is hidden.
Answer run_null(std::uint64_t seed, const std::string& name);

/// The larger ratio of error to noise floor of training and validation of a whole case, after a refit of the base. It
/// shows how much there is to find.
double error_of_whole_case(const std::filesystem::path& folder);

/// Forecasts in ten bins of probability.
struct Reliability {
  struct Bin {
    std::size_t count = 0;
    double forecast = 0.0;   ///< mean probability
    double came_true = 0.0;  ///< fraction that came true, 0..1
  };
  std::vector<Bin> bins;
  double expected_error = 0.0;  ///< mean of |forecast - came_true| over all forecasts (expected calibration error)
};

Reliability reliability_of(const std::vector<Forecast>& forecasts);

/// The most probable forecast of each answer.
std::vector<Forecast> top_forecasts(const std::vector<Answer>& answers);
std::vector<Forecast> all_forecasts(const std::vector<Answer>& answers);

}  // namespace host
