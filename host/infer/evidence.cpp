#include "host/infer/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/dense_solutions.hpp"

namespace host {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Degrees of freedom of the t distribution of the innovations (Lange et al. 1989).
constexpr double kDegrees = 4.0;
/// A memory below this part of its usual size counts as zero. The prior favours zero with the weight of two
/// observations.
constexpr double kNoSize = 0.01, kEarlierObservations = 2.0;
/// Starting size of a fit that searches for a large memory.
constexpr double kLargeSize = 0.1;
constexpr int kMostWeighings = 12, kRoundsToSettle = 3, kSizesARound = 8;
/// Smallest gain of a round, nats, after which a further round follows.
constexpr double kSettled = 0.02;

double log_student(double square) {
  static const double constant =
      std::lgamma(0.5 * (kDegrees + 1.0)) - std::lgamma(0.5 * kDegrees) - 0.5 * std::log(kDegrees * std::numbers::pi);
  return constant - 0.5 * (kDegrees + 1.0) * std::log1p(square / kDegrees);
}

}  // namespace

Evidence::Evidence(VectorXd y, std::vector<RowRun> runs, Memory memory, double least_noise, NoiseKind kind)
    : y_(std::move(y)), runs_(std::move(runs)), memory_(std::move(memory)), least_noise_(least_noise), kind_(kind) {}

VectorXd Evidence::no_memory() const {
  return VectorXd::Constant(static_cast<Index>(memory_.groups.size()), kNoSize * memory_.usual);
}

namespace {

/// Prior standard deviations of all columns; those of the memory for its present sizes.
VectorXd all_deviations(const VectorXd& deviations, const Memory& memory, const VectorXd& sizes) {
  VectorXd all(deviations.size() + memory.columns.cols());
  all.head(deviations.size()) = deviations;
  for (std::size_t g = 0; g < memory.groups.size(); ++g)
    all.segment(deviations.size() + memory.groups[g].first, memory.groups[g].count)
        .setConstant(sizes(static_cast<Index>(g)));
  return all;
}

/// The information matrix of the factors in units of their prior standard deviations, factorised.
Eigen::LLT<MatrixXd> information_of(const MatrixXd& gram, const VectorXd& deviations) {
  MatrixXd scaled = deviations.asDiagonal() * gram * deviations.asDiagonal();
  scaled.diagonal().array() += 1.0;
  return Eigen::LLT<MatrixXd>(scaled);
}

/// One step of the fixed-point iteration for the sizes of the memory. Returns the largest relative change.
double renew_sizes(const Memory& memory, Index known, const MatrixXd& gram, const VectorXd& projection,
                   const VectorXd& deviations, VectorXd& sizes) {
  const VectorXd all = all_deviations(deviations, memory, sizes);
  const Eigen::LLT<MatrixXd> information = information_of(gram, all);
  const VectorXd mean = all.cwiseProduct(information.solve(all.cwiseProduct(projection)));
  const MatrixXd inverse_root = information.matrixL().solve(MatrixXd::Identity(gram.rows(), gram.cols()));
  const VectorXd variance = all.cwiseProduct(all).cwiseProduct(inverse_root.colwise().squaredNorm().transpose());
  const double nothing = std::pow(kNoSize * memory.usual, 2);
  double most = 0.0;
  for (std::size_t g = 0; g < memory.groups.size(); ++g) {
    const MemoryGroup& group = memory.groups[g];
    double& now = sizes(static_cast<Index>(g));
    // MacKay's fixed point (ch. 27), from the number of the group's factors that the data determine.
    const double determined =
        static_cast<double>(group.count) - variance.segment(known + group.first, group.count).sum() / (now * now);
    const double squares = mean.segment(known + group.first, group.count).squaredNorm() + 2.0 * nothing;
    const double size = std::sqrt(squares / (std::max(determined, 0.0) + kEarlierObservations + 2.0));
    most = std::max(most, std::abs(size / now - 1.0));
    now = size;
  }
  return most;
}

}  // namespace

EvidenceFit Evidence::fit(const MatrixXd& columns, const VectorXd& deviations, const EvidenceStart& start) const {
  const Index known = columns.cols(), n = y_.size();
  MatrixXd all(n, known + memory_.columns.cols());
  all << columns, memory_.columns;
  EvidenceFit fit;
  fit.sizes = start.sizes;
  fit.colour = start.colour;
  VectorXd unit_weights = VectorXd::Ones(n), factors;
  double square = -1.0, before = -HUGE_VAL;
  MatrixXd products;
  VectorXd white_y, deviations_now;
  MatrixXd white;
  for (int round = 0; round < kMostWeighings; ++round) {
    white = whiten(all, fit.colour);
    white_y = whiten(y_, fit.colour);
    if (square < 0.0)
      square = std::max(white_y.squaredNorm() / static_cast<double>(n) / 4.0, std::pow(least_noise_, 2));
    const VectorXd root = (unit_weights / square).cwiseSqrt();
    const MatrixXd weighed = root.asDiagonal() * white;
    products = gram(weighed);
    const VectorXd projection = weighed.transpose() * root.cwiseProduct(white_y);
    if (!start.hold_sizes)
      for (int step = 0; step < kSizesARound; ++step)
        if (renew_sizes(memory_, known, products, projection, deviations, fit.sizes) < 0.03) break;
    deviations_now = all_deviations(deviations, memory_, fit.sizes);
    fit.information = information_of(products, deviations_now);
    factors = deviations_now.cwiseProduct(fit.information.solve(deviations_now.cwiseProduct(projection)));
    fit.residual = white_y - white * factors;
    // Weights and scale of the t distribution alternately.
    for (int step = 0; step < 4; ++step) {
      unit_weights = ((kDegrees + 1.0) / (kDegrees + fit.residual.array().square() / square)).matrix();
      square = std::max(unit_weights.dot(fit.residual.cwiseAbs2()) / static_cast<double>(n), std::pow(least_noise_, 2));
    }
    double log_evidence = -0.5 * static_cast<double>(n) * std::log(square) +
                          static_cast<double>(runs_.size()) * std::log(fit.colour.innovation());
    for (Index k = 0; k < n; ++k) log_evidence += log_student(fit.residual(k) * fit.residual(k) / square);
    const MatrixXd& lower = fit.information.matrixLLT();
    log_evidence -= 0.5 * factors.cwiseQuotient(deviations_now).squaredNorm() + lower.diagonal().array().log().sum();
    const VectorXd relative = fit.sizes / (kNoSize * memory_.usual);
    log_evidence -= (2.0 * relative.array().log() + relative.array().square().inverse()).sum();
    fit.log_evidence = log_evidence;
    fit.weights = unit_weights / square;
    fit.noise = std::sqrt(square);
    const bool is_behind = round + 1 >= kRoundsToSettle && log_evidence < start.give_up;
    if (std::abs(log_evidence - before) < kSettled || is_behind || round + 1 == kMostWeighings) break;
    before = log_evidence;
    fit.colour = colour_of(kind_, y_ - all * factors, unit_weights, runs_);
  }
  fit.whitened = white * deviations_now.asDiagonal();
  fit.factors = factors.head(known);
  fit.remembered = memory_.columns * factors.tail(memory_.columns.cols());
  return fit;
}

EvidenceFit Evidence::fit(const MatrixXd& columns, const VectorXd& deviations) const {
  EvidenceFit large = fit(columns, deviations, {.sizes = no_memory() * (kLargeSize / kNoSize)});
  EvidenceFit small = fit(columns, deviations, {.colour = large.colour, .sizes = no_memory()});
  return large.log_evidence > small.log_evidence ? large : small;
}

EvidenceFit Evidence::fit_from(const EvidenceFit& before, const MatrixXd& columns, const VectorXd& deviations,
                               double give_up) const {
  EvidenceStart start{.colour = before.colour, .sizes = before.sizes, .give_up = give_up};
  EvidenceFit same = fit(columns, deviations, start);
  const VectorXd none = no_memory();
  if ((before.sizes.array() <= none.array()).all()) return same;
  start.sizes = none;
  EvidenceFit small = fit(columns, deviations, start);
  return same.log_evidence > small.log_evidence ? same : small;
}

VectorXd Evidence::gains(const EvidenceFit& fit, const MatrixXd& further, const std::vector<int>& sign,
                         const VectorXd& scales) const {
  const MatrixXd white = whiten(further, fit.colour);
  const MatrixXd weighed = fit.weights.asDiagonal() * white;
  const MatrixXd cross = fit.whitened.transpose() * weighed;
  const MatrixXd own = weighed.transpose() * white - cross.transpose() * fit.information.solve(cross);
  const VectorXd pull = weighed.transpose() * fit.residual;
  for (Index c = 0; c < pull.size(); ++c)
    if (sign[static_cast<std::size_t>(c)] > 0 && pull(c) < 0.0) return VectorXd::Constant(scales.size(), -HUGE_VAL);
  // Along the principal axes of the columns' information; directions within the span of the known columns add nothing.
  constexpr double kOwnPart = 1e-9;
  const SymmetricSpectrum axes = symmetric_spectrum(own);
  const VectorXd along = axes.vectors.transpose() * pull;
  const double least = kOwnPart * (weighed.cwiseProduct(white)).sum();
  VectorXd gains = VectorXd::Zero(scales.size());
  for (Index a = 0; a < along.size(); ++a) {
    if (!(axes.values(a) > least)) continue;
    const Eigen::ArrayXd square = scales.array().square(), grown = 1.0 + square * axes.values(a);
    gains.array() += 0.5 * (square * along(a) * along(a) / grown - grown.log());
  }
  return gains;
}

}  // namespace host
