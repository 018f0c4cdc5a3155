#include "host/effort/closest_form.hpp"

#include <algorithm>
#include <utility>

#include "host/cancellation.hpp"
#include "host/parallel.hpp"

namespace host {

namespace {

void step_to_closest(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                     const std::vector<EffortTerm>& chosen, FittedForm& form) {
  constexpr double kFirstPart = 0.03, kLastPart = 0.001;  // from a quarter of the distance between forms to 0.1 %
  constexpr double kLeastStep = 1e-4;                     // of the error: smaller gains are noise
  std::vector<const EffortTerm*> further = pointers_to(chosen);
  further.push_back(nullptr);
  for (double part = kFirstPart; part > kLastPart && form.term.neighbours;) {
    throw_if_cancelled();
    bool closer = false;
    for (const auto& make : form.term.neighbours(part)) {
      EffortTerm neighbour = make();
      ScreenedModel tried = form.model;
      further.back() = &neighbour;
      if (!regression.fit(base, further, tried) || tried.train > (1.0 - kLeastStep) * form.model.train) continue;
      tried.words = neighbour.words;
      form = {std::move(neighbour), std::move(tried)};
      closer = true;
      break;
    }
    if (!closer) part *= 0.5;
  }
}

}  // namespace

FittedForm closest_form(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                        const std::vector<EffortTerm>& chosen, std::vector<FittedForm> starts) {
  for_each_in_parallel(starts.size(), [&](std::size_t k) { step_to_closest(regression, base, chosen, starts[k]); });
  return std::move(*std::ranges::min_element(starts, {}, [](const FittedForm& form) { return form.model.train; }));
}

}  // namespace host
