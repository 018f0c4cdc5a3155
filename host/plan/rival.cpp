#include "host/plan/rival.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "host/exit_codes.hpp"
#include "host/fit/base_fit.hpp"
#include "host/fit/model_fit.hpp"
#include "host/parallel.hpp"
#include "host/search/candidate_starts.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// As many iterations as the last fit of a diagnosis.
constexpr FitOptions kFit{.most_iterations = 15, .least_gain = 1e-5, .most_steps = 40e6};

/// The best fit of the effect from all of its starts, if the search found no promising one.
sim::DriveDescription best_start(const sim::EffectInfo& info, const sim::DriveDescription& model,
                                 const RecordSet& training) {
  constexpr std::size_t kStarts = 3;
  std::vector<sim::DriveDescription> starts = starting_models(info, model, training);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < starts.size(); ++k)
    order.emplace_back(error_of(sim::Drive(starts[k]), training).robust, k);
  std::ranges::sort(order);
  order.resize(std::min(order.size(), kStarts));
  FitResult best;
  best.robust = HUGE_VAL;
  for (const auto& [error, k] : order)
    if (FitResult fit = fit_model(starts[k], training, kFit); fit.robust < best.robust) best = std::move(fit);
  if (best.model.effects.empty())
    throw Failure(ExitCode::usage,
                  fmt::format("{}: these records give no starting value: no period is significant", info.kind));
  return best.model;
}

sim::DriveDescription with_effect(const std::string& kind, const sim::DriveDescription& model,
                                  const sim::DriveDescription& nominal, const RecordSet& training) {
  const sim::EffectInfo* info = sim::find_effect(kind);
  if (info == nullptr)
    throw Failure(ExitCode::usage, fmt::format("effect '{}' is unknown; `axistool effects` lists them", kind));
  if (!is_applicable(*info, model, training))
    throw Failure(ExitCode::usage, fmt::format("{}: cannot be added: the model already has it (perhaps in another "
                                               "form) or excludes it, or these records lack the channel that shows it",
                                               kind));
  SearchEffort effort;
  effort.nominal = &nominal;
  const std::vector<Candidate> found = search_kinds({info}, model, {}, training, training, {}, effort);
  return found.empty() ? best_start(*info, model, training) : found.front().model;
}

/// Adds the effect to a model that already fits well; only the parameters of the effect are fitted first. Empty if the
/// effect cannot be added to the model.
std::optional<sim::DriveDescription> with_effect_alone(const std::string& kind, const sim::DriveDescription& model,
                                                       const RecordSet& training) {
  constexpr FitOptions kAlone{.most_iterations = 8, .least_gain = 1e-3, .freedom = Freedom::last_effect};
  const sim::EffectInfo& info = *sim::find_effect(kind);
  if (!is_applicable(info, model, training)) return {};
  FitResult best;
  best.robust = HUGE_VAL;
  for (const sim::DriveDescription& start : starting_models(info, model, training))
    if (FitResult fit = fit_model(start, training, kAlone); fit.robust < best.robust) best = std::move(fit);
  if (best.model.effects.empty()) return {};
  return best.model;
}

/// A fitted rival with its kinds replaced, and fitted again. Empty if that is impossible, or if both kinds describe the
/// same part of the drive: a gap of zero width is a spring, and so is not another explanation.
std::optional<sim::DriveDescription> exchanged(const Rival& from, const std::vector<std::string>& kinds,
                                               const RecordSet& training) {
  const auto has = [](const std::vector<std::string>& list, const std::string& kind) {
    return std::ranges::find(list, kind) != list.end();
  };
  for (const std::string& old : from.kinds)
    for (const std::string& kind : kinds)
      if (!has(kinds, old) && !has(from.kinds, kind) &&
          exclude_each_other(*sim::find_effect(old), *sim::find_effect(kind)))
        return {};
  std::optional<sim::DriveDescription> model = from.model;
  std::erase_if(model->effects, [&](const sim::EffectEntry& effect) {
    return has(from.kinds, effect.kind) && !has(kinds, effect.kind);
  });
  for (const std::string& kind : kinds)
    if (model && !has(from.kinds, kind)) model = with_effect_alone(kind, *model, training);
  if (model) model = refitted(*model, training);
  return model;
}

/// Takes the better fit for every rival: its own, or one that starts from `from`.
void start_again(std::vector<Rival>& rivals, const Rival& from, const RecordSet& ground) {
  for_each_in_parallel(rivals.size(), [&](std::size_t k) {
    std::optional<sim::DriveDescription> other = exchanged(from, rivals[k].kinds, ground);
    if (other && chi_square(*other, ground) < chi_square(rivals[k].model, ground)) rivals[k].model = std::move(*other);
  });
}

}  // namespace

std::string rival_name(const std::vector<std::string>& kinds) { return fmt::format("{}", fmt::join(kinds, " + ")); }

std::vector<Rival> fit_rivals(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                              const std::vector<std::vector<std::string>>& kinds, const ShareDone& progress,
                              const Rival* known) {
  RecordSet set = compare_on(training, model);
  const sim::DriveDescription base = fit_base(model, set);
  renew_floors(set, base);
  std::vector<Rival> rivals;
  for (const std::vector<std::string>& names : kinds) {
    Rival rival{names, base, 1.0 / static_cast<double>(kinds.size())};
    for (const std::string& kind : names) rival.model = with_effect(kind, rival.model, model, set);
    rivals.push_back(std::move(rival));
    if (progress) progress(static_cast<double>(rivals.size()) / static_cast<double>(kinds.size()));
  }
  const RecordSet ground = common_ground(training, rivals);
  for (Rival& rival : rivals) rival.model = refitted(rival.model, ground);
  if (known != nullptr) start_again(rivals, *known, ground);
  const auto cost = [&](const Rival& rival) { return chi_square(rival.model, ground); };
  const Rival best = *std::ranges::min_element(rivals, {}, cost);
  start_again(rivals, best, ground);
  return rivals;
}

std::vector<Rival> rivals_of(const Diagnosis& diagnosis, const std::vector<const Record*>& records) {
  std::vector<Rival> rivals;
  if (diagnosis.verdict.status != Status::ambiguous) return rivals;
  std::vector<std::string> group = diagnosis.verdict.effects;
  for (const std::vector<std::string>& kinds : diagnosis.verdict.alternatives)
    group.insert(group.end(), kinds.begin(), kinds.end());
  double sum = 0.0;
  for (const JudgedCandidate& candidate : diagnosis.candidates) {
    if (candidate.kinds.size() != 1 || std::ranges::find(group, candidate.kinds.front()) == group.end()) continue;
    rivals.push_back({candidate.kinds, candidate.model, candidate.probability});
    sum += candidate.probability;
  }
  if (rivals.size() < 2) return {};
  for (Rival& rival : rivals)
    rival.probability = sum > 0.0 ? rival.probability / sum : 1.0 / static_cast<double>(rivals.size());
  const RecordSet ground = common_ground(records, rivals);
  for (Rival& rival : rivals) rival.model = refitted(rival.model, ground);
  return rivals;
}

std::vector<Rival> rivals_for(const sim::DriveDescription& model, const Measurements& measured,
                              const std::vector<const Record*>& records,
                              const std::vector<std::vector<std::string>>& kinds, const ShareDone& progress) {
  if (!kinds.empty()) return fit_rivals(model, records, kinds, progress);
  const Diagnosis diagnosis = diagnose(model, measured, progress);
  std::vector<Rival> rivals = rivals_of(diagnosis, records);
  if (rivals.empty())
    throw Failure(ExitCode::answer_is_no,
                  fmt::format("nothing is left to separate: the verdict on these records is {}{}{}. --rivals A,B plans "
                              "a run for two explanations anyway",
                              status_name(diagnosis.verdict.status), diagnosis.verdict.effects.empty() ? "" : ": ",
                              fmt::join(diagnosis.verdict.effects, " + ")));
  return rivals;
}

RecordSet common_ground(const std::vector<const Record*>& records, const std::vector<Rival>& rivals, double window_s) {
  RecordSet set = compare_on(records, rivals.front().model, window_s);
  double common = set.common_square;
  for (std::size_t r = 1; r < rivals.size(); ++r) {
    RecordSet own = set;
    renew_floors(own, rivals[r].model);
    common = std::min(common, own.common_square);
    const auto widen = [](std::vector<double>& floor, const std::vector<double>& other) {
      for (std::size_t k = 0; k < floor.size(); ++k) floor[k] = std::max(floor[k], other[k]);
    };
    for (std::size_t k = 0; k < set.records.size(); ++k) {
      widen(set.records[k].floor.x, own.records[k].floor.x);
      widen(set.records[k].floor.w, own.records[k].floor.w);
    }
  }
  set.common_square = common;
  return set;
}

RecordSet part_of(const RecordSet& set, std::size_t begin, std::size_t end) {
  RecordSet part = set;
  part.records.assign(set.records.begin() + static_cast<std::ptrdiff_t>(begin),
                      set.records.begin() + static_cast<std::ptrdiff_t>(end));
  return part;
}

double chi_scale(const RecordSet& set) {
  double count = 0.0;
  for (const ComparedRecord& compared : set.records)
    count += static_cast<double>(compared.prepared.windows.size() * channel_count(compared, set.measure));
  return count * kCommonSquare / set.common_square;
}

double chi_square_each(const sim::DriveDescription& model, const RecordSet& set) {
  const double robust = error_of(sim::Drive(model), set).robust;
  return robust * robust * kCommonSquare / set.common_square;
}

double chi_square(const sim::DriveDescription& model, const RecordSet& set) {
  const double robust = error_of(sim::Drive(model), set).robust;
  return chi_scale(set) * robust * robust;
}

sim::DriveDescription refitted(const sim::DriveDescription& start, const RecordSet& set) {
  return fit_model(start, set, kFit).model;
}

}  // namespace host
