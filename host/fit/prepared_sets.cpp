#include "host/fit/prepared_sets.hpp"

#include <algorithm>
#include <cmath>

#include "host/fit/base_fit.hpp"

namespace host {

namespace {

/// The motion is divided into about two dozen blocks with these bounds of their length, s of motion. Within two seconds
/// the motion hardly changes its kind, and 0.3 s still contain three windows.
constexpr double kBlocks = 24.0;
constexpr double kShortestBlock_s = 0.3, kLongestBlock_s = 2.0;
/// One block in four is held back; one in three if there is little motion.
constexpr std::size_t kUsualEvery = 4, kEveryOfFew = 3;
constexpr double kFew_s = 30.0;

/// Whether the axis moves at a row: its smoothed speed exceeds three standard deviations of that speed.
std::vector<bool> moving_rows(const PreparedRecord& prepared) {
  constexpr double kDeviations = 3.0;
  const SmoothedMotion& motion = prepared.motion();
  std::vector<bool> moves(motion.w.size());
  for (std::size_t k = 0; k < moves.size(); ++k)
    moves[k] = !motion.standing[k] && std::abs(motion.w[k]) > kDeviations * std::sqrt(motion.w_variance[k]);
  return moves;
}

double moving_s_of(const Window& window, const std::vector<bool>& moves, double period_s) {
  std::size_t rows = 0;
  for (std::size_t k = window.begin; k < window.begin + window.length; ++k)
    if (moves[k]) ++rows;
  return static_cast<double>(rows) * period_s;
}

double moving_s_of(const RecordSet& set) {
  double sum = 0.0;
  for (const ComparedRecord& compared : set.records) {
    const std::vector<bool> moves = moving_rows(compared.prepared);
    for (const Window& window : compared.prepared.windows)
      sum += moving_s_of(window, moves, compared.prepared.period_s);
  }
  return sum;
}

/// The block number of each window, one list per record. A block has this many seconds of motion and includes the
/// standstill that follows. The numbers continue from record to record; a block ends with its record.
std::vector<std::vector<std::size_t>> blocks_of(const RecordSet& set, double block_s) {
  std::vector<std::vector<std::size_t>> blocks;
  std::size_t block = 0;
  for (const ComparedRecord& compared : set.records) {
    const PreparedRecord& prepared = compared.prepared;
    const std::vector<bool> moves = moving_rows(prepared);
    std::vector<std::size_t> own;
    double moved_s = 0.0;
    for (const Window& window : prepared.windows) {
      const double more_s = moving_s_of(window, moves, prepared.period_s);
      if (more_s > 0.0 && moved_s > block_s - 0.5 * more_s) {
        ++block;
        moved_s = 0.0;
      }
      moved_s += more_s;
      own.push_back(block);
    }
    if (moved_s > 0.0) ++block;
    blocks.push_back(std::move(own));
  }
  return blocks;
}

/// A record without windows is skipped, because its window length is unknown.
void drop_empty(RecordSet& set) {
  const auto is_empty = [](const ComparedRecord& compared) { return compared.prepared.windows.empty(); };
  if (!std::ranges::all_of(set.records, is_empty)) std::erase_if(set.records, is_empty);
}

}  // namespace

std::size_t independent_windows(double moving_s) {
  constexpr double kRounding = 1e-6;
  return static_cast<std::size_t>(moving_s / kIndependent_s + kRounding);
}

double missing_motion_s(const PreparedSets& sets) {
  const double learn_s = std::max(0.0, static_cast<double>(kFewestToLearn) * kIndependent_s - sets.moving_train_s);
  const double judge_s = std::max(0.0, static_cast<double>(kFewestToJudge) * kIndependent_s - sets.moving_validate_s);
  if (!sets.held_back) return learn_s + judge_s;
  const auto every = static_cast<double>(std::max<std::size_t>(2, sets.blocks.every));
  return std::max(learn_s * every / (every - 1.0), judge_s * every);
}

KeptBack hold_back(RecordSet& training, RecordSet& validation) {
  const double moving_s = moving_s_of(training);
  const KeptBack kept{std::clamp(moving_s / kBlocks, kShortestBlock_s, kLongestBlock_s),
                      moving_s < kFew_s ? kEveryOfFew : kUsualEvery};
  const std::vector<std::vector<std::size_t>> blocks = blocks_of(training, kept.block_s);
  validation = training;
  for (std::size_t r = 0; r < training.records.size(); ++r) {
    PreparedRecord& trains = training.records[r].prepared;
    PreparedRecord& judges = validation.records[r].prepared;
    const std::vector<Window> all = trains.windows;
    const std::size_t reach = trains.smoother->reach();
    trains.windows.clear();
    judges.windows.clear();
    std::vector<bool> near(trains.record->size(), false);  // rows that affect a validation window
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (blocks[r][k] % kept.every != kept.every - 1) continue;
      judges.windows.push_back(all[k]);
      const std::size_t begin = all[k].begin - std::min(all[k].begin, reach);
      const std::size_t end = std::min(near.size(), all[k].begin + all[k].length + reach + 1);
      std::fill(near.begin() + static_cast<std::ptrdiff_t>(begin), near.begin() + static_cast<std::ptrdiff_t>(end),
                true);
    }
    for (const Window& window : all)
      if (!near[window.begin] && !near[window.begin + window.length]) trains.windows.push_back(window);
  }
  drop_empty(training);
  drop_empty(validation);
  return kept;
}

RecordSet together(const RecordSet& a, const RecordSet& b) {
  RecordSet all = a;
  all.records.insert(all.records.end(), b.records.begin(), b.records.end());
  return all;
}

PreparedSets split_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                        const std::vector<const Record*>& validation, double window_s, Measure measure) {
  PreparedSets sets;
  sets.window_s = window_s;
  sets.measure = measure;
  sets.held_back = validation.empty();
  sets.training = compare_on(training, model, window_s, measure);
  if (sets.held_back) {
    sets.blocks = hold_back(sets.training, sets.validation);
    renew_floors(sets.training, model);
    renew_floors(sets.validation, model);
  } else {
    sets.validation = compare_on(validation, model, window_s, measure);
  }
  sets.base = model;
  sets.moving_train_s = moving_s_of(sets.training);
  sets.moving_validate_s = moving_s_of(sets.validation);
  sets.moves_enough = independent_windows(sets.moving_train_s) >= kFewestToLearn &&
                      independent_windows(sets.moving_validate_s) >= kFewestToJudge;
  return sets;
}

PreparedSets with_base_fitted(PreparedSets sets) {
  if (!sets.moves_enough) return sets;
  sets.base = fit_base(sets.base, sets.training);
  renew_floors(sets.training, sets.base);
  renew_floors(sets.validation, sets.base);
  return sets;
}

PreparedSets prepare_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                          const std::vector<const Record*>& validation, double window_s, Measure measure) {
  return with_base_fitted(split_sets(model, training, validation, window_s, measure));
}

}  // namespace host
