#include "sim/curve.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

Curve::Curve(const EffectEntry& entry) {
  for (std::size_t n = 0; entry.has(numbered_id("knot", static_cast<double>(n))); ++n) {
    knots_.push_back(entry.at(numbered_id("knot", static_cast<double>(n))));
    values_.push_back(entry.at(numbered_id("value", static_cast<double>(n))));
  }
  if (entry.over == "phase" && !knots_.empty()) period_ = knots_.back() - knots_.front();
}

double Curve::folded(double q) const {
  return period_ > 0.0 ? q - period_ * std::floor((q - knots_.front()) / period_) : q;
}

double Curve::operator()(double q) const {
  if (knots_.empty()) return 0.0;
  q = folded(q);
  const auto above = std::ranges::upper_bound(knots_, q);
  if (above == knots_.begin()) return values_.front();
  if (above == knots_.end()) return values_.back();
  const auto k = static_cast<std::size_t>(above - knots_.begin());
  const double part = (q - knots_[k - 1]) / (knots_[k] - knots_[k - 1]);
  return values_[k - 1] + part * (values_[k] - values_[k - 1]);
}

double Curve::slope(double q) const {
  q = folded(q);
  const auto above = std::ranges::upper_bound(knots_, q);
  if (above == knots_.begin() || above == knots_.end()) return 0.0;
  const auto k = static_cast<std::size_t>(above - knots_.begin());
  return (values_[k] - values_[k - 1]) / (knots_[k] - knots_[k - 1]);
}

}  // namespace sim
