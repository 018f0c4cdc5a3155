#include "host/effort/hidden_pair.hpp"

#include <cmath>
#include <initializer_list>

#include "host/cancellation.hpp"

namespace host {

namespace {

bool need_each_other(const ScreenedModel& now, const ScreenedModel& one, const ScreenedModel& other,
                     const ScreenedModel& both) {
  const auto more = [&](double ScreenedModel::*error) {
    const auto square = [&](const ScreenedModel& of) { return of.*error * of.*error; };
    return square(both) + square(now) < square(one) + square(other);
  };
  return more(&ScreenedModel::train) && more(&ScreenedModel::validate);
}

}  // namespace

const NextEffect* less_seen_of_two(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                                   const std::vector<EffortTerm>& chosen, const ScreenedModel& now,
                                   const NextEffects& all,
                                   const std::function<bool(const ScreenedModel&)>& is_worth_naming) {
  const auto fitted = [&](std::initializer_list<const EffortTerm*> more, ScreenedModel& out) {
    std::vector<const EffortTerm*> further = pointers_to(chosen);
    further.insert(further.end(), more);
    return regression.fit(base, further, out);
  };
  struct Alone {
    const NextEffect* effect;
    ScreenedModel model;
  };
  std::vector<Alone> singles;
  for (const NextEffect& effect : all.effects)
    if (Alone alone{&effect, {}}; !effect.term.can_repeat && fitted({&effect.term}, alone.model))
      singles.push_back(std::move(alone));
  const NextEffect* less_seen = nullptr;
  double least = HUGE_VAL;
  for (std::size_t a = 0; a < singles.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      throw_if_cancelled();
      const Alone &one = singles[a], &other = singles[b];
      ScreenedModel both;
      if (!fitted({&one.effect->term, &other.effect->term}, both) || both.train >= least || !is_worth_naming(both) ||
          !need_each_other(now, one.model, other.model, both))
        continue;
      least = both.train;
      less_seen = one.model.train > other.model.train ? one.effect : other.effect;
    }
  return less_seen;
}

}  // namespace host
