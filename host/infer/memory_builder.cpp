#include "host/infer/memory_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/dense_solutions.hpp"

namespace host {

using Eigen::Index;
using Eigen::MatrixXd;

std::vector<double> even_knots(double low, double high, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k) knots.push_back(low + (high - low) * k / (count - 1));
  return knots;
}

std::vector<double> knots_by_factor(double low, double high, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k) knots.push_back(low * std::pow(high / low, static_cast<double>(k) / (count - 1)));
  return knots;
}

MatrixXd hats(const Eigen::VectorXd& at, const std::vector<double>& knots) {
  MatrixXd columns = MatrixXd::Zero(at.size(), static_cast<Index>(knots.size()));
  for (Index k = 0; k < at.size(); ++k) {
    const double q = std::clamp(at(k), knots.front(), knots.back());
    const auto above = std::ranges::upper_bound(knots.begin() + 1, knots.end() - 1, q);
    const auto n = static_cast<Index>(above - knots.begin());
    const auto i = static_cast<std::size_t>(n);
    const double part = (q - knots[i - 1]) / (knots[i] - knots[i - 1]);
    columns(k, n - 1) = 1.0 - part;
    columns(k, n) = part;
  }
  return columns;
}

MatrixXd beside(const MatrixXd& columns, const MatrixXd& others) {
  return columns - others * least_squares_solution(others, columns);
}

void MemoryBuilder::add(std::string coordinate, const MatrixXd& columns) {
  const Index first = memory_.columns.cols();
  for (Index c = 0; c < columns.cols(); ++c) {
    if (columns.col(c).cwiseAbs().maxCoeff() <= 0.0) continue;
    memory_.columns.conservativeResize(columns.rows(), memory_.columns.cols() + 1);
    memory_.columns.rightCols(1) = columns.col(c);
  }
  if (memory_.columns.cols() > first)
    memory_.groups.push_back({std::move(coordinate), first, memory_.columns.cols() - first});
}

Memory MemoryBuilder::take(double usual) {
  memory_.usual = usual;
  return std::move(memory_);
}

}  // namespace host
