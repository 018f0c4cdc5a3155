#include "host/identify/repeated_counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace host {

namespace {

/// Sums of products of two values of the response, by their distance in rows, over the sum of squares.
std::vector<double> autocorrelation(std::span<const double> response) {
  std::vector<double> products(response.size());
  for (std::size_t apart = 0; apart < products.size(); ++apart)
    products[apart] = std::inner_product(response.begin() + static_cast<std::ptrdiff_t>(apart), response.end(),
                                         response.begin(), 0.0);
  const double square = products.empty() ? 0.0 : products.front();
  for (double& product : products) product /= std::max(square, 1e-300);
  return products;
}

/// The factor as a function of the fractional part of the counts per sample.
class FactorBySpeed {
 public:
  explicit FactorBySpeed(std::span<const double> response) {
    const std::vector<double> products = autocorrelation(response);
    for (std::size_t n = 0; n < values_.size(); ++n) {
      const double counts = static_cast<double>(n) / static_cast<double>(values_.size());
      double sum = 1.0;
      for (std::size_t apart = 1; apart < products.size(); ++apart) {
        const double far = counts * static_cast<double>(apart), part = far - std::floor(far);
        sum += 2.0 * products[apart] * (1.0 - 6.0 * part * (1.0 - part));
      }
      values_[n] = sum;
    }
  }

  double operator()(double counts) const {
    const double part = (counts - std::floor(counts)) * static_cast<double>(values_.size());
    return values_[static_cast<std::size_t>(part) % values_.size()];
  }

 private:
  std::array<double, 1024> values_{};
};

}  // namespace

std::vector<double> repeated_counts(std::span<const double> travel, double step, std::span<const double> response) {
  const std::size_t rows = travel.size(), reach = std::max<std::size_t>(1, response.size() / 2);
  std::vector<double> factors(rows, 1.0);
  if (rows < 2) return factors;
  const FactorBySpeed factor(response);
  std::vector<double> sums(rows + 1, 0.0);
  const auto around = [&](std::size_t row) {
    return std::pair{row - std::min(row, reach), std::min(row + reach, rows - 1)};
  };
  for (std::size_t row = 0; row < rows; ++row) {
    const auto [first, last] = around(row);
    sums[row + 1] =
        sums[row] + factor(std::abs(travel[last] - travel[first]) / (step * static_cast<double>(last - first)));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const auto [first, last] = around(row);
    factors[row] = std::max(1.0, (sums[last + 1] - sums[first]) / static_cast<double>(last + 1 - first));
  }
  return factors;
}

}  // namespace host
