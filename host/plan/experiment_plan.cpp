#include "host/plan/experiment_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/exit_codes.hpp"
#include "host/known_by_current.hpp"
#include "host/parallel.hpp"
#include "host/plan/information.hpp"
#include "host/plan/primitives.hpp"
#include "host/plan/simulated_run.hpp"

namespace host {

namespace {

/// Log odds that are expected to stay above kHighestOdds whatever the noise: 7 for the odds, and twice their standard
/// deviation, the square root of twice themselves.
constexpr double kEnough = 20.0;
/// With so much left after a rival has bent in earnest the odds will reach kHighestOdds: half as much again as they
/// are.
const double kSure = 1.5 * std::log(kHighestOdds);
/// Less than this is no hope of a decision.
const double kHope = std::log(kDecided / (1.0 - kDecided));
/// A run stays this share of the box's half away from its edge, for what the simulated machines do not know.
constexpr double kBoxShare = 0.95;
/// What a piece costs beside its own time: enabling, stopping, resting.
constexpr double kOverhead_s = 0.3;

/// A rival at one place of its parameters: where the training records put it, or where it has bent to since.
struct Incarnation {
  sim::DriveDescription model;
  Information known;  ///< of the training records
};

/// chi^2 of every incarnation on the record that a piece makes with one of the rivals being true: [rival][incarnation].
using Testimony = std::vector<std::vector<Information>>;

struct TriedPiece {
  RunPiece piece;
  std::vector<Record> records;       ///< [rival that is true]
  std::vector<Testimony> testimony;  ///< [rival that is true]; empty where the piece is of no use
};

class Planner {
 public:
  Planner(const sim::DriveDescription& model, const std::vector<const Record*>& training,
          const std::vector<Rival>& rivals, const ExcitationLimits& box, const PlanOptions& options,
          const ShareDone& progress)
      : model_(model),
        rivals_(rivals),
        box_(box),
        options_(options),
        progress_(progress),
        ground_(common_ground(training, rivals)),
        board_(design_values(model)) {
    plan_.rivals = rivals;
    for (const Rival& rival : rivals) {
      incarnations_.push_back({{rival.model, information_of(rival.model, ground_)}});
      at_first_.push_back(incarnations_.back().front().known.least());
      dispersion_ = std::min(dispersion_, chi_square_each(rival.model, ground_));
    }
    dispersion_ = std::max(1.0, dispersion_);
  }

  Plan make() {
    try_pieces(candidate_pieces(model_, box_));
    choose();
    // A rival that bends further than its slope foretold is held against the pieces from where it went.
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds && !chosen_.empty(); ++round) {
      if (verify() || round + 1 == kRounds) break;
      choose();
    }
    conclude();
    return std::move(plan_);
  }

 private:
  void try_pieces(const std::vector<RunPiece>& pieces) {
    constexpr std::size_t kBatch = 8;  // the budget ends between batches, on every machine between the same
    for (std::size_t begin = 0; begin < pieces.size(); begin += kBatch) {
      if (plan_.steps >= options_.most_steps) {
        plan_.cut_short = true;
        return;
      }
      const std::size_t count = std::min(kBatch, pieces.size() - begin);
      std::vector<TriedPiece> tried(count);
      std::vector<double> steps(count, 0.0);
      for_each_in_parallel(count, [&](std::size_t k) { tried[k] = try_piece(pieces[begin + k], steps[k]); });
      for (std::size_t k = 0; k < count; ++k) {
        plan_.steps += steps[k];
        if (!tried[k].testimony.empty()) tried_.push_back(std::move(tried[k]));
      }
      if (progress_) progress_(0.8 * static_cast<double>(begin + count) / static_cast<double>(pieces.size()));
    }
  }

  TriedPiece try_piece(const RunPiece& piece, double& steps) const {
    TriedPiece tried{piece, {}, {}};
    for (std::size_t truth = 0; truth < rivals_.size(); ++truth) {
      std::optional<Record> record = simulated({{piece}, box_, {}, 0.0}, truth, options_.seed + truth);
      if (!record) return {piece, {}, {}};
      tried.records.push_back(std::move(*record));
    }
    for (std::size_t truth = 0; truth < rivals_.size(); ++truth) {
      const RecordSet set = common_ground({&tried.records[truth]}, rivals_);
      Testimony testimony;
      for (const std::vector<Incarnation>& rival : incarnations_) {
        testimony.emplace_back();
        for (const Incarnation& incarnation : rival) {
          testimony.back().push_back(information_of(incarnation.model, set));
          steps += steps_of_information(incarnation.model, set);
        }
      }
      tried.testimony.push_back(std::move(testimony));
    }
    return tried;
  }

  /// Nothing where the run leaves the box, comes near its edge, or is refused.
  std::optional<Record> simulated(const RunPlan& run, std::size_t truth, std::uint64_t seed) const {
    try {
      RunOutcome outcome = simulate_run(run, rivals_[truth].model, board_, seed);
      if (!outcome.completed || outcome.farthest > 0.5 * kBoxShare * box_.travel) return {};
      return std::move(outcome.record);
    } catch (const Failure&) {
      return {};
    }
  }

  /// Log odds of the rival that is true to another after some pieces, the other bent as far as it can.
  double log_odds(const std::vector<std::size_t>& pieces, std::size_t truth, std::size_t other) const {
    const auto cost = [&](std::size_t rival) {
      double least = HUGE_VAL;
      for (std::size_t k = 0; k < incarnations_[rival].size(); ++k) {
        Information sum = incarnations_[rival][k].known;
        for (const std::size_t piece : pieces) sum += tried_[piece].testimony[truth][rival][k];
        least = std::min(least, sum.least());
      }
      return least - at_first_[rival];
    };
    return 0.5 * (cost(other) - cost(truth)) / dispersion_;
  }

  double worst(const std::vector<std::size_t>& pieces, const PairOutlook& pair) const {
    return std::min(log_odds(pieces, pair.a, pair.b), log_odds(pieces, pair.b, pair.a));
  }

  std::vector<PairOutlook> all_pairs() const {
    std::vector<PairOutlook> pairs;
    for (std::size_t a = 0; a < rivals_.size(); ++a)
      for (std::size_t b = a + 1; b < rivals_.size(); ++b) pairs.push_back({a, b});
    return pairs;
  }

  double value_of(const std::vector<std::size_t>& pieces) const {
    double value = 0.0;
    for (const PairOutlook& pair : plan_.pairs)
      if (pair.separable) value += std::min(worst(pieces, pair), kEnough);
    return value;
  }

  /// The pieces that bring most a second, until every pair that any of them separates has enough or the time is over.
  void choose() {
    plan_.pairs = all_pairs();
    chosen_.clear();
    double wanted = 0.0;
    for (PairOutlook& pair : plan_.pairs) {
      for (std::size_t piece = 0; piece < tried_.size() && !pair.separable; ++piece)
        pair.separable = worst({piece}, pair) > kHope;
      if (pair.separable) wanted += kEnough;
    }
    double time_s = 0.0, value = 0.0;
    constexpr std::size_t kMostPieces = 6;
    while (chosen_.size() < kMostPieces && value < wanted) {
      std::size_t best = tried_.size();
      double best_rate = 0.0, best_value = value;
      for (std::size_t piece = 0; piece < tried_.size(); ++piece) {
        const double cost_s = tried_[piece].piece.time_s + kOverhead_s;
        if (time_s + cost_s > box_.time_s || std::ranges::find(chosen_, piece) != chosen_.end()) continue;
        std::vector<std::size_t> with = chosen_;
        with.push_back(piece);
        const double then = value_of(with);
        constexpr double kWorthwhile = 0.5;
        if (then - value < kWorthwhile || (then - value) / cost_s <= best_rate) continue;
        best = piece;
        best_rate = (then - value) / cost_s;
        best_value = then;
      }
      if (best == tried_.size()) break;
      chosen_.push_back(best);
      time_s += tried_[best].piece.time_s + kOverhead_s;
      value = best_value;
    }
  }

  /// Simulates the whole run with noise of its own, lets every rival bend in earnest, and notes the odds. True where
  /// they are what was expected; otherwise the bent rivals are incarnations from now on.
  bool verify() {
    plan_.run.pieces.clear();
    for (const std::size_t piece : chosen_) plan_.run.pieces.push_back(tried_[piece].piece);
    plan_.run.box = box_;
    plan_.predicted.clear();
    std::vector<std::vector<double>> odds(rivals_.size(), std::vector<double>(rivals_.size(), 0.0));
    bool as_expected = true;
    std::vector<std::pair<std::size_t, sim::DriveDescription>> bent;
    for (std::size_t truth = 0; truth < rivals_.size(); ++truth) {
      constexpr std::uint64_t kOtherNoise = 1000;
      std::optional<Record> record = simulated(plan_.run, truth, options_.seed + kOtherNoise + truth);
      if (!record) {  // the pieces one after the other leave the box: the last is one too many
        chosen_.pop_back();
        return chosen_.empty() || verify();
      }
      const Decision decision = decide_on(rivals_, ground_, common_ground({&*record}, rivals_));
      plan_.predicted.push_back({std::move(*record), {}});
      for (const Rival& rival : decision.rivals) plan_.predicted.back().bent.push_back(rival.model);
      for (std::size_t other = 0; other < rivals_.size(); ++other) {
        odds[truth][other] = 0.5 * (decision.chi_square[other] - decision.chi_square[truth]);
        const double found = odds[truth][other];
        const bool may_have_more = other != truth && found < kSure && log_odds(chosen_, truth, other) > found + kHope;
        if (!may_have_more) continue;
        as_expected = false;
        bent.emplace_back(other, decision.rivals[other].model);
      }
    }
    for (PairOutlook& pair : plan_.pairs) {
      pair.separable = std::min(odds[pair.a][pair.b], odds[pair.b][pair.a]) > kHope;
      pair.odds_if_a = stated_odds(std::exp(odds[pair.a][pair.b]));
      pair.odds_if_b = stated_odds(std::exp(odds[pair.b][pair.a]));
    }
    for (const auto& [rival, model] : bent) incarnate(rival, model);
    return as_expected;
  }

  void incarnate(std::size_t rival, const sim::DriveDescription& model) {
    incarnations_[rival].push_back({model, information_of(model, ground_)});
    for_each_in_parallel(tried_.size(), [&](std::size_t k) {
      for (std::size_t truth = 0; truth < rivals_.size(); ++truth)
        tried_[k].testimony[truth][rival].push_back(
            information_of(model, common_ground({&tried_[k].records[truth]}, rivals_)));
    });
  }

  void conclude() {
    std::vector<std::string> by_hand;
    std::vector<double> odds(rivals_.size(), kHighestOdds);  // of each to the next, if it is the true one
    for (PairOutlook& pair : plan_.pairs) {
      if (pair.separable) {
        plan_.separable = true;
        odds[pair.a] = std::min(odds[pair.a], pair.odds_if_a);
        odds[pair.b] = std::min(odds[pair.b], pair.odds_if_b);
        continue;
      }
      pair.odds_if_a = pair.odds_if_b = 1.0;
      pair.by_hand = separation_by_hand(rivals_[pair.a].kinds, rivals_[pair.b].kinds);
      if (std::ranges::find(by_hand, pair.by_hand) == by_hand.end()) by_hand.push_back(pair.by_hand);
    }
    double log_odds = 0.0;
    for (std::size_t k = 0; k < rivals_.size(); ++k) log_odds += rivals_[k].probability * std::log(odds[k]);
    plan_.expected_odds = stated_odds(std::exp(log_odds));
    for (const std::string& text : by_hand) plan_.by_hand += (plan_.by_hand.empty() ? "" : " ") + text;
    for (std::size_t k = 0; k < tried_.size(); ++k) {
      double least = HUGE_VAL;
      for (const PairOutlook& pair : plan_.pairs)
        if (pair.separable) least = std::min(least, worst({k}, pair));
      plan_.considered.push_back({tried_[k].piece, std::isfinite(least) ? least : 0.0});
    }
    std::ranges::stable_sort(plan_.considered, std::greater{}, &ConsideredPiece::expected_log_odds);
    plan_.run.box = box_;
    for (const Rival& rival : rivals_) plan_.run.rivals.push_back(rival_name(rival.kinds));
    if (plan_.separable) {
      plan_.run.expected_odds = plan_.expected_odds;
    } else {
      plan_.run.pieces.clear();
      plan_.predicted.clear();
      plan_.expected_odds = 1.0;
    }
    if (progress_) progress_(1.0);
  }

  const sim::DriveDescription& model_;
  const std::vector<Rival>& rivals_;
  ExcitationLimits box_;
  PlanOptions options_;
  const ShareDone& progress_;
  RecordSet ground_;
  firmware::ParameterValues board_;
  std::vector<std::vector<Incarnation>> incarnations_;
  std::vector<double> at_first_;  ///< chi^2 of each rival on the training records
  double dispersion_ = HUGE_VAL;  ///< of the best of them there
  std::vector<TriedPiece> tried_;
  std::vector<std::size_t> chosen_;
  Plan plan_;
};

}  // namespace

Plan plan_run(const sim::DriveDescription& model, const std::vector<const Record*>& training,
              const std::vector<Rival>& rivals, const ExcitationLimits& box, const PlanOptions& options,
              const ShareDone& progress) {
  require_volts(model.data, model.name, "a planned run");
  if (rivals.size() < 2)
    throw Failure(ExitCode::usage,
                  "a run needs at least two rivals: give --rivals A,B, or records for which diagnose leaves several");
  return Planner(model, training, rivals, box, options, progress).make();
}

}  // namespace host
