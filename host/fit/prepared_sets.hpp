// Inputs of a diagnosis: training windows, validation windows, and the base fitted to the training windows.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// Motions of this length are independent, because each window restarts from the measured state.
inline constexpr double kIndependent_s = 0.1;
/// Smallest numbers of independent windows of motion for training and for validation. With fewer windows, inertia and
/// friction, or a model with and without an effect, cannot be told apart.
inline constexpr std::size_t kFewestToLearn = 10;
inline constexpr std::size_t kFewestToJudge = 8;

/// The blocks of the training data that are held back if there is no validation record.
struct KeptBack {
  double block_s = 0.0;   ///< motion in a block, s
  std::size_t every = 0;  ///< one block in this many is held back; 0 if none is
};

struct PreparedSets {
  double window_s = kWindow_s;
  Measure measure = Measure::motion;
  bool held_back = false;  ///< validation data are held-back blocks of the training data
  KeptBack blocks;
  double moving_train_s = 0.0, moving_validate_s = 0.0;  ///< time in motion within the windows that are used
  bool moves_enough = false;                             ///< otherwise the base is the given model
  sim::DriveDescription base;                            ///< the given model, re-fitted
  RecordSet training, validation;
  std::vector<std::string> absent = {};  ///< kinds that this machine is known not to have, which are not candidates
};

/// Number of independent windows in this many seconds of motion.
std::size_t independent_windows(double moving_s);

/// Seconds of further motion that a diagnosis needs; 0 if there is enough.
double missing_motion_s(const PreparedSets& sets);

/// Holds back a quarter or a third of the blocks of windows, across all records. A block has 0.3 to 2 s of motion, so
/// that even a single short record gives some. Training windows within the smoother's reach of a held-back block are
/// not used.
KeptBack hold_back(RecordSet& training, RecordSet& validation);

/// Both sets as one, each with its noise floors. With more records, effects that repeat along the travel become more
/// significant and single events less.
RecordSet together(const RecordSet& a, const RecordSet& b);

/// The two sets with the noise floors of the given model, which stays the base. Throws as prepare_sets() does.
PreparedSets split_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                        const std::vector<const Record*>& validation, double window_s = kWindow_s,
                        Measure measure = Measure::motion);

/// The sets with a refitted base and its noise floors; unchanged if the axis hardly moves.
PreparedSets with_base_fitted(PreparedSets sets);

/// The sets, noise floors and refitted base with which a diagnosis begins. Throws Failure(bad_input) for records that
/// cannot be compared. Keeps references to the records.
PreparedSets prepare_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                          const std::vector<const Record*>& validation, double window_s = kWindow_s,
                          Measure measure = Measure::motion);

}  // namespace host
