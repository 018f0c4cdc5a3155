#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "host/dense_solutions.hpp"
#include "host/inner_products_kernel.hpp"

namespace {

struct ThisProcessor;

/// Sizes that are no multiples of a block's, and more rows than a block has.
class InnerProducts : public testing::TestWithParam<std::pair<Eigen::Index, Eigen::Index>> {};

TEST_P(InnerProducts, AreThoseOfTheDefinitionAndEqualOnEveryProcessor) {
  const auto [rows, count] = GetParam();
  const Eigen::MatrixXd columns = Eigen::MatrixXd::NullaryExpr(rows, count, [](Eigen::Index row, Eigen::Index column) {
    return std::sin(1.0 + 3.7 * static_cast<double>(row) + 1.3 * static_cast<double>(column * column));
  });
  const Eigen::MatrixXd products = host::gram(columns);
  Eigen::MatrixXd here(count, count);
  host::inner_products<ThisProcessor>(columns.data(), static_cast<std::size_t>(rows), static_cast<std::size_t>(count),
                                      here.data());
  EXPECT_EQ(products, here);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      double sum = 0.0;
      for (Eigen::Index row = 0; row < rows; ++row) sum += columns(row, i) * columns(row, j);
      EXPECT_NEAR(products(i, j), sum, 1e-12 * static_cast<double>(rows)) << i << ", " << j;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, InnerProducts,
                         testing::Values(std::pair(0, 3), std::pair(3, 1), std::pair(511, 5), std::pair(512, 4),
                                         std::pair(1030, 7), std::pair(2051, 10)));

}  // namespace
