#include "host/effort/effort_screen.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "host/cancellation.hpp"
#include "host/effort/closest_form.hpp"
#include "host/effort/effort_regression.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/inverse_model.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An effect earns its place when it takes this part of the error, on training rows, and on the rows that judge.
constexpr double kLeastTrainGain = 0.05, kLeastGain = 0.1;
/// A further one must take half of the squared error that a model could take, which is what comes back when a motion is
/// repeated, and all of it where none was: a machine's residual has many small causes.
constexpr double kLeastFurtherPart = 0.5;
/// And this part of the effort: below lies what no model of a machine is worth.
constexpr double kLeastPart = 0.005;
constexpr double kLeastConfidence = 0.99;
/// Where the base leaves more than this part of the effort, what is missing is large: an effect must take half of the
/// squared error there, or it stands for another one (a ripple for a current limit).
constexpr double kBaseFails = 0.1;
constexpr double kLeastGainWhereBaseFails = 0.29;
/// A second mass bends to anything that lasts, a gap or a current limit too: it must take two thirds of the squared
/// error, as it does where it is really there.
constexpr double kLeastGainOfSpring = 0.42;
/// What is left must stand so far above the sensors' noise: terms that smooth the motion take noise alone.
constexpr double kAboveNoise = 2.0;
/// Effects whose errors are so close are not told apart; the simpler one goes before.
constexpr double kTie = 0.04;

double product(const ScreenedModel& model) { return model.train * model.validate; }

/// What stands beside a search: the columns that are fitted anyway.
MatrixXd columns_of(const EffortScreen& screen, const std::vector<EffortTerm>& base,
                    const std::vector<EffortTerm>& chosen) {
  MatrixXd columns(screen.rows.effort.size(), 0);
  for (const auto* list : {&base, &chosen})
    for (const EffortTerm& term : *list) {
      if (list == &base && screen.rows.steady && term.kind == "inertia") continue;  // it is held
      const Index width = columns.cols();
      columns.conservativeResize(Eigen::NoChange, width + term.columns.cols());
      columns.rightCols(term.columns.cols()) = term.columns;
    }
  return columns;
}

/// Everything that could come next on top of what was chosen.
std::vector<EffortTerm> next_terms(const EffortScreen& screen, const sim::DriveDescription& given,
                                   const std::vector<EffortTerm>& base, const std::vector<EffortTerm>& chosen,
                                   const std::vector<std::string>& absent) {
  sim::DriveDescription held = given;
  for (const EffortTerm& term : chosen)
    if (held.find(term.kind) == nullptr) held.effects.push_back({term.kind, {}, {}, {}});
  const ScreenedModel& now = screen.best();
  std::vector<EffortTerm> terms = further_terms(held, screen.rows, columns_of(screen, base, chosen),
                                                screen.rows.effort - now.residual, now.residual);
  std::erase_if(terms, [&](const EffortTerm& term) {
    return std::ranges::find(now.kinds, term.kind) != now.kinds.end() ||
           std::ranges::find(absent, term.kind) != absent.end();
  });
  return terms;
}

struct Tried {
  ScreenedModel model;
  std::vector<const EffortTerm*> terms;  ///< on top of what was chosen
};

bool can_be_claimed(const Tried& tried) { return std::ranges::all_of(tried.terms, &EffortTerm::can_be_claimed); }

/// Keeps the best form of each combination of kinds, by its error on the training rows.
void keep(std::vector<Tried>& found, Tried tried) {
  const auto same =
      std::ranges::find_if(found, [&](const Tried& other) { return other.model.kinds == tried.model.kinds; });
  if (same == found.end()) {
    found.push_back(std::move(tried));
  } else if (tried.model.train < same->model.train) {
    *same = std::move(tried);
  }
}

std::vector<Tried> try_all(const EffortRegression& regression, const EffortScreen& screen,
                           const std::vector<EffortTerm>& base, const std::vector<EffortTerm>& chosen,
                           const std::vector<std::vector<const EffortTerm*>>& combinations) {
  const ScreenedModel& now = screen.best();
  std::vector<Tried> found;
  for (const std::vector<const EffortTerm*>& terms : combinations) {
    throw_if_cancelled();
    std::vector<const EffortTerm*> further;
    for (const EffortTerm& before : chosen) further.push_back(&before);
    further.insert(further.end(), terms.begin(), terms.end());
    Tried tried{{}, terms};
    if (!regression.fit(base, further, tried.model)) continue;
    tried.model.kinds = now.kinds;
    for (const EffortTerm* term : terms) tried.model.kinds.push_back(term->kind);
    tried.model.words = terms.back()->words;
    keep(found, std::move(tried));
  }
  // What differs in the last digits alone keeps the catalogue's order.
  std::ranges::stable_sort(found, {}, [](const Tried& tried) { return std::round(1e6 * product(tried.model)); });
  for (Tried& tried : found)
    tried.model.confidence = can_be_claimed(tried) ? regression.confidence(now, tried.model) : 0.0;
  return found;
}

std::vector<std::vector<const EffortTerm*>> one_by_one(const std::vector<EffortTerm>& terms) {
  std::vector<std::vector<const EffortTerm*>> combinations;
  for (const EffortTerm& term : terms) combinations.push_back({&term});
  return combinations;
}

/// Two effects that hide each other when judged one at a time: a low-speed shape of friction and a delay, say.
std::vector<std::vector<const EffortTerm*>> by_two(const std::vector<EffortTerm>& terms) {
  const auto cheap = [](const EffortTerm& term) { return term.kind != "compliance" && term.columns.cols() <= 2; };
  std::vector<std::vector<const EffortTerm*>> combinations;
  for (auto first = terms.begin(); first != terms.end(); ++first)
    for (auto second = std::next(first); second != terms.end(); ++second)
      if (first->kind != second->kind && cheap(*first) && cheap(*second)) combinations.push_back({&*first, &*second});
  return combinations;
}

bool earns_its_place(const ScreenedModel& after, const ScreenedModel& before, double least_gain) {
  return after.validate < (1.0 - least_gain) * before.validate &&
         after.train < (1.0 - kLeastTrainGain) * before.train &&
         after.fast_validate < (1.0 - least_gain) * before.fast_validate &&
         after.fast_train < (1.0 - kLeastTrainGain) * before.fast_train &&
         before.validate - after.validate > kLeastPart && after.confidence >= kLeastConfidence;
}

/// The force balance over whole records, reversals included, which the rows leave out: RMS over the records of what the
/// inverse model leaves. Empty where it has none.
std::optional<double> balance_error(const sim::DriveDescription& model, const RecordSet& set) {
  double square = 0.0;
  try {
    for (const ComparedRecord& compared : set.records)
      square += std::pow(relative_error(model, *compared.prepared.record), 2);
  } catch (const Failure&) {
    return {};
  }
  return std::sqrt(square / static_cast<double>(set.records.size()));
}

/// Whether an effect takes its part at the reversals, where a delay and the shape of friction at low speed show most.
/// Only of records of their own: blocks of one record share its balance.
bool takes_its_part_at_reversals(const ScreenedModel& after, const ScreenedModel& before, double least_gain,
                                 const RecordSet& training, const RecordSet& validation) {
  const auto record_of = [](const ComparedRecord& compared) { return compared.prepared.record; };
  if (std::ranges::find(validation.records, record_of(training.records.front()), record_of) != validation.records.end())
    return false;
  return std::ranges::all_of(std::array{&training, &validation}, [&](const RecordSet* set) {
    const std::optional<double> from = balance_error(before.model, *set), to = balance_error(after.model, *set);
    return from && to && *to < (1.0 - least_gain) * *from;
  });
}

/// Blocks of half a second that judge.
std::size_t judging_blocks(const EffortRows& rows) {
  std::set<std::pair<std::size_t, std::size_t>> blocks;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows.judges[k]) blocks.emplace(rows.record[k], rows.block[k]);
  return blocks.size();
}

/// What a further effect must take of the error, by what of its square comes back.
double least_further_gain(const EffortScreen& screen) {
  const std::optional<Repeatability> found = repeatability(screen.rows, screen.best().residual);
  const double share = found ? found->share : 1.0;
  return std::max(kLeastGain, 1.0 - std::sqrt(1.0 - kLeastFurtherPart * share));
}

bool near(const ScreenedModel& a, const ScreenedModel& best) {
  return a.train <= (1.0 + kTie) * best.train && a.validate <= (1.0 + kTie) * best.validate;
}

/// An effect that was chosen first may have stood for two that came later: each is tried without.
void drop_what_others_explain(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                              const RecordSet& training, const RecordSet& validation, std::vector<EffortTerm>& chosen,
                              EffortScreen& screen) {
  for (std::size_t k = 0; chosen.size() > 1 && k + 1 < chosen.size();) {
    std::vector<const EffortTerm*> others;
    for (std::size_t n = 0; n < chosen.size(); ++n)
      if (n != k) others.push_back(&chosen[n]);
    ScreenedModel without;
    if (!regression.fit(base, others, without) || earns_its_place(screen.best(), without, kLeastGain) ||
        takes_its_part_at_reversals(screen.best(), without, kLeastGain, training, validation)) {
      ++k;
      continue;
    }
    for (const EffortTerm* term : others) without.kinds.push_back(term->kind);
    without.words = others.back()->words;
    without.confidence = regression.confidence(screen.base, without);
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(k));
    screen.chosen.back() = std::move(without);
    // Steps that held it are none any more.
    screen.chosen.erase(screen.chosen.begin(), screen.chosen.end() - 1);
    screen.tied.erase(screen.tied.begin(), screen.tied.end() - 1);
  }
}

}  // namespace

EffortScreen screen_effort(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                           std::size_t most_steps, const std::vector<std::string>& absent) {
  EffortScreen screen;
  if (model.find("inertia") == nullptr || !has_inverse(sim::Drive(model))) return screen;
  screen.rows = effort_rows(model, training, validation);
  if (screen.empty()) return screen;
  const EffortRegression regression(model, screen.rows);
  screen.effort_train = root_mean_square(screen.rows, screen.rows.effort, false);
  screen.effort_validate = root_mean_square(screen.rows, screen.rows.effort, true);
  screen.rows.effort -= standing_effort(model, screen.rows);
  const std::vector<EffortTerm> base = base_terms(model, screen.rows);
  if (!(screen.effort_train > 0.0) || !(screen.effort_validate > 0.0) ||
      !regression.fit(base, {}, screen.base, &screen.held))
    return {};
  if (screen.rows.steady) screen.held.emplace_back("the speed hardly changes, so the inertia does not show");

  // Of some hundred forms and pairs one suits a block or two by chance.
  constexpr std::size_t kFewestToGoOn = 4;
  const bool enough_to_go_on = judging_blocks(screen.rows) >= kFewestToGoOn;
  std::vector<EffortTerm> chosen;
  while (screen.chosen.size() < most_steps) {
    if (screen.best().validate * screen.effort_validate < kAboveNoise * screen.rows.noise) break;
    if (!chosen.empty() && !enough_to_go_on) break;
    const std::vector<EffortTerm> terms = next_terms(screen, model, base, chosen, absent);
    std::vector<Tried> found = try_all(regression, screen, base, chosen, one_by_one(terms));
    screen.steps.emplace_back();
    for (const Tried& tried : found) screen.steps.back().push_back(tried.model);
    if (found.empty()) break;
    const ScreenedModel before = screen.best();
    const double further_gain = least_further_gain(screen);
    const double first_gain = screen.base.validate > kBaseFails ? kLeastGainWhereBaseFails : kLeastGain;
    const double least_gain = chosen.empty() ? first_gain : further_gain;
    // Of those that are as good as the best one, the simplest.
    std::erase_if(found, [&](const Tried& tried) {
      return tried.model.kinds.back() == "compliance" && !earns_its_place(tried.model, before, kLeastGainOfSpring);
    });
    if (found.empty()) break;
    const Tried* best = &found.front();
    for (const Tried& tried : found) {
      const bool simpler = can_be_claimed(tried) == can_be_claimed(*best) && tried.model.factors < best->model.factors;
      if (near(tried.model, found.front().model) && (simpler || (can_be_claimed(tried) && !can_be_claimed(*best))))
        best = &tried;
    }
    std::vector<Tried> pairs;
    if (!earns_its_place(best->model, before, least_gain)) {
      // Two at once must take as much as a further one.
      pairs = try_all(regression, screen, base, chosen, by_two(terms));
      if (pairs.empty()) break;
      const ScreenedModel& pair = pairs.front().model;
      const bool at_reversals = !chosen.empty() && earns_its_place(pair, before, kLeastGain) &&
                                takes_its_part_at_reversals(pair, before, further_gain, training, validation);
      if (!earns_its_place(pair, before, further_gain) && !at_reversals) break;
      best = &pairs.front();
      screen.steps.back().push_back(best->model);
    }
    std::vector<std::string> tied;
    if (pairs.empty())
      for (const Tried& other : found)
        if (&other != best && can_be_claimed(other) && near(other.model, best->model) &&
            other.model.factors <= best->model.factors)
          tied.push_back(other.model.kinds.back());
    screen.tied.push_back(std::move(tied));
    ScreenedModel taken = best->model;
    if (best->terms.size() == 1 && best->terms.front()->neighbours) {
      EffortTerm closest = closest_form(regression, base, chosen, *best->terms.front(), taken);
      if (closest.at_frequency && std::ranges::find(absent, "backlash") == absent.end()) {
        screen.hardening = spring_hardening(model, screen.rows, base, chosen, closest);
        if (screen.hardening && screen.hardening->shows_a_gap()) screen.tied.back().emplace_back("backlash");
      }
      chosen.push_back(std::move(closest));
    } else
      for (const EffortTerm* term : best->terms) chosen.push_back(*term);
    *std::ranges::find(screen.steps.back(), taken.kinds, &ScreenedModel::kinds) = taken;
    screen.chosen.push_back(std::move(taken));
  }
  drop_what_others_explain(regression, base, training, validation, chosen, screen);
  if (screen.chosen.empty()) {
    EffortRows swapped = screen.rows;
    swapped.judges.flip();
    ScreenedModel alone;
    if (EffortRegression(model, swapped).fit(base, {}, alone)) screen.judge_alone = std::move(alone);
  }
  screen.repeatable = repeatability(screen.rows, screen.best().residual);
  return screen;
}

std::optional<ScreenedModel> refitted_with(const EffortScreen& screen, const EffortTerm& term) {
  const ScreenedModel& now = screen.best();
  // What stands beside the term is fitted again where the regression knows all of it.
  const bool whole = screen.chosen.empty() || has_linear_form(now.model);
  const EffortRegression regression(now.model, screen.rows, whole ? screen.rows.effort : now.residual);
  ScreenedModel with;
  if (!regression.fit(whole ? base_terms(now.model, screen.rows) : std::vector<EffortTerm>{}, {&term}, with)) return {};
  with.kinds = now.kinds;
  with.kinds.push_back(term.kind);
  with.words = term.words;
  with.train = root_mean_square(screen.rows, with.residual, false) / screen.effort_train;
  with.validate = root_mean_square(screen.rows, with.residual, true) / screen.effort_validate;
  with.confidence = regression.confidence(now, with);
  return with;
}

}  // namespace host
