#include "host/diagnose/prepared_sets.hpp"

#include <algorithm>
#include <cmath>

#include "host/diagnose/candidate_search.hpp"

namespace host {

namespace {

/// Blocks of this length alternate between training and validation where no validation record is given, s.
constexpr double kBlock_s = 2.0;
/// Every so many-th block is kept back.
constexpr std::size_t kKeptBack = 4;

/// Splits the windows of a set into training and validation blocks.
void hold_back(RecordSet& training, RecordSet& validation) {
  validation = training;
  for (std::size_t r = 0; r < training.records.size(); ++r) {
    PreparedRecord& kept = training.records[r].prepared;
    PreparedRecord& back = validation.records[r].prepared;
    const std::vector<Window> all = kept.windows;
    kept.windows.clear();
    back.windows.clear();
    for (const Window& window : all) {
      const double t_s = static_cast<double>(window.begin) * kept.period_s;
      const bool held = static_cast<std::size_t>(t_s / kBlock_s) % kKeptBack == kKeptBack - 1;
      (held ? back : kept).windows.push_back(window);
    }
  }
}

/// Excitation below which nothing can be said: the axis must move for a second in all.
bool moves_enough(const RecordSet& set) {
  double moving_s = 0.0;
  for (const ComparedRecord& compared : set.records) {
    const SmoothedMotion& motion = compared.prepared.motion();
    double top = 0.0;
    for (const double w : motion.w) top = std::max(top, std::abs(w));
    for (std::size_t k = 0; k < motion.w.size(); ++k)
      if (!motion.standing[k] && std::abs(motion.w[k]) > 0.05 * top) moving_s += compared.prepared.period_s;
  }
  constexpr double kShortestMotion_s = 1.0;
  return moving_s >= kShortestMotion_s;
}

}  // namespace

PreparedSets prepare_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                          const std::vector<const Record*>& validation, double window_s, Measure measure) {
  PreparedSets sets;
  sets.window_s = window_s;
  sets.measure = measure;
  sets.held_back = validation.empty();
  sets.training = compare_on(training, model, window_s, measure);
  if (sets.held_back) {
    hold_back(sets.training, sets.validation);
  } else {
    sets.validation = compare_on(validation, model, window_s, measure);
  }
  sets.base = model;
  sets.moves_enough = moves_enough(sets.training);
  if (!sets.moves_enough) return sets;
  sets.base = fit_base(model, sets.training);
  renew_floors(sets.training, sets.base);
  renew_floors(sets.validation, sets.base);
  return sets;
}

}  // namespace host
