#include "host/effort/closest_form.hpp"

#include <utility>

#include "host/cancellation.hpp"

namespace host {

EffortTerm closest_form(const EffortRegression& regression, const std::vector<EffortTerm>& base,
                        const std::vector<EffortTerm>& chosen, EffortTerm term, ScreenedModel& model) {
  constexpr double kFirstPart = 0.03, kLastPart = 0.001;  // from a quarter of the distance between forms to 0.1 %
  constexpr double kLeastStep = 1e-4;                     // of the error: smaller gains are noise
  std::vector<const EffortTerm*> further = pointers_to(chosen);
  further.push_back(nullptr);
  for (double part = kFirstPart; part > kLastPart && term.neighbours;) {
    throw_if_cancelled();
    bool closer = false;
    for (EffortTerm& neighbour : term.neighbours(part)) {
      ScreenedModel tried = model;
      further.back() = &neighbour;
      if (!regression.fit(base, further, tried) || tried.train > (1.0 - kLeastStep) * model.train) continue;
      tried.words = neighbour.words;
      model = std::move(tried);
      term = std::move(neighbour);
      closer = true;
      break;
    }
    if (!closer) part *= 0.5;
  }
  return term;
}

}  // namespace host
