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

/// Log odds that exceed kHighestOdds for any noise: 7 for the odds, plus two standard deviations; the standard
/// deviation is the square root of twice the log odds.
constexpr double kEnough = 20.0;
/// If the log odds reach this value after a complete fit of the other rival, they will exceed those of kHighestOdds
/// even if they fall by a third.
const double kSure = 1.5 * std::log(kHighestOdds);
/// Log odds below this cannot lead to a decision.
const double kHope = std::log(kDecided / (1.0 - kDecided));
/// Largest distance of a simulated run from the start, as a part of half the box. The margin covers effects that the
/// simulated machines lack.
constexpr double kBoxShare = 0.95;
/// Time of a piece in addition to its own: enabling, stopping and resting.
constexpr double kOverhead_s = 0.3;

/// A rival with one set of parameters: from the training records or from a later fit.
struct Incarnation {
  sim::DriveDescription model;
  Information known;  ///< information from the training records
};

/// chi^2 of every incarnation on the record of a piece if one rival is true: [rival][incarnation].
using Testimony = std::vector<std::vector<Information>>;

struct TriedPiece {
  RunPiece piece;
  std::vector<Record> records;       ///< [rival that is true]
  std::vector<Testimony> testimony;  ///< [rival that is true]; empty if the piece cannot be used
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
    // If the fit of a rival moves farther than its linearisation predicted, the pieces are compared again from its new
    // parameters.
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
    constexpr std::size_t kBatch = 8;  // the budget ends between batches, at the same point on every machine
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

  /// Empty if the run is refused, leaves the box or comes near its edge.
  std::optional<Record> simulated(const RunPlan& run, std::size_t truth, std::uint64_t seed) const {
    try {
      RunOutcome outcome = simulate_run(run, rivals_[truth].model, board_, seed);
      if (!outcome.completed || outcome.farthest > 0.5 * kBoxShare * box_.travel) return {};
      return std::move(outcome.record);
    } catch (const Failure&) {
      return {};
    }
  }

  /// Log odds of the true rival to another one after some pieces, with the other one refitted.
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

  /// Chooses the pieces with the largest gain per second, until every separable pair has enough or the time is used up.
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

  /// Simulates the whole run with new noise, fits every rival completely, and stores the odds. Returns true if they are
  /// as expected; otherwise the fitted rivals become incarnations.
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
      if (!record) {  // the sequence of pieces leaves the box; removes the last one
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
    std::vector<double> odds(rivals_.size(), kHighestOdds);  // of each rival, if it is true, to the next one
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
  double dispersion_ = HUGE_VAL;  ///< of the best rival on the training records
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
