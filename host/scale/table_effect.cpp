#include "host/scale/table_effect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/report/text_format.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"
#include "sim/drive.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TableSize size(std::string name, std::string unit, double value, double deviation) {
  return {std::move(name), std::move(unit), value, {value - kNormal95 * deviation, value + kNormal95 * deviation}};
}

std::string in_words(const TableSize& size) {
  return fmt::format("{:.4g} {} (95 %: {:.4g} to {:.4g})", size.value, size.unit, size.ci95[0], size.ci95[1]);
}

/// Amplitude of a wave and its standard deviation, from its two factors.
TableSize amplitude_of(std::string name, const VectorXd& factors, const MatrixXd& covariance) {
  const double value = factors.norm();
  const VectorXd along = factors / std::max(value, 1e-12);
  return size(std::move(name), "um", value, std::sqrt(std::max(0.0, along.dot(covariance * along))));
}

/// Discs, couplings, pole pairs and resolvers have an error a few times per turn. A grating may have it with any
/// period.
constexpr int kFewParts = 8;

/// n if the period is a turn of the motor divided by n, within the resolution of the travel; empty otherwise.
std::optional<int> part_of_a_turn(double period, const TableRows& rows, double turn) {
  constexpr int kMostParts = 512;
  const double travel = rows.x.maxCoeff() - rows.x.minCoeff();
  const double waves = turn / period, resolved = 0.5 * turn / travel;
  const double whole = std::round(waves);
  if (!(turn > 0.0) || whole < 1.0 || whole > kMostParts || std::abs(waves - whole) > resolved) return {};
  return static_cast<int>(whole);
}

void fill_pitch(const TableTerm& term, const VectorXd& factors, const MatrixXd& covariance, const TableRows& rows,
                double to_unit, TableEffect& effect) {
  constexpr int kPoints = 41;
  const double low = rows.x.minCoeff(), high = rows.x.maxCoeff(), period = kPitchPeriod * term.shape[1];
  MatrixXd at(kPoints, factors.size());
  for (int p = 0; p < kPoints; ++p) {
    const double x = low + (high - low) * p / (kPoints - 1);
    at(p, 0) = 1e-3 * (x - term.shape[0]);
    for (int order = 1; order <= kPitchOrders; ++order) {
      const double phase = 2.0 * std::numbers::pi * order * (x - term.shape[0]) / period;
      at(p, 2 * order - 1) = std::cos(phase);
      at(p, 2 * order) = std::sin(phase);
    }
  }
  const MatrixXd centred = at.rowwise() - at.colwise().mean();
  // Slope of the whole curve, a linear function of the factors.
  const VectorXd slope = (centred.transpose() * centred.col(0)) / centred.col(0).squaredNorm();
  effect.sizes.push_back(size("lead_error", "um/m", slope.dot(factors), std::sqrt(slope.dot(covariance * slope))));
  const VectorXd curve = centred * factors;
  for (int p = 0; p < kPoints; ++p) {
    const VectorXd row = centred.row(p).transpose();
    effect.curve.push_back({low + (high - low) * p / (kPoints - 1), curve(p), std::sqrt(row.dot(covariance * row))});
  }
  const double spread = curve.maxCoeff() - curve.minCoeff();
  double deviation = 0.0;
  for (const TablePoint& point : effect.curve) deviation = std::max(deviation, point.deviation_um);
  effect.sizes.push_back(size("spread", "um", spread, std::numbers::sqrt2 * deviation));
  std::vector<sim::HarmonicTerm> harmonics;
  for (int order = 1; order <= kPitchOrders; ++order) {
    // Converts waves about the middle of the travel to waves about zero.
    const double turn = 2.0 * std::numbers::pi * order * term.shape[0] / period;
    const double c = factors(2 * order - 1), s = factors(2 * order);
    harmonics.push_back({static_cast<double>(order), to_unit * (c * std::cos(turn) - s * std::sin(turn)),
                         to_unit * (c * std::sin(turn) + s * std::cos(turn))});
  }
  effect.entry.parameters["lead_error"] = factors(0);
  effect.entry.parameters["period"] = 1e3 * to_unit * period;
  sim::set_harmonics(effect.entry, harmonics);
  effect.words = fmt::format("pitch error of the screw: {} of lead, {:.3g} um over {:.4g} mm",
                             in_words(effect.sizes[0]), spread, high - low);
}

/// `own`: covariance of the term's factors: first the lag in um per mm/s^2, then the logarithm of the deceleration.
void fill_compliance(const TableTerm& term, const MatrixXd& own, const sim::DriveDescription& model,
                     TableEffect& effect) {
  const double lag = 1e3 * term.drive.lag, lag_off = std::sqrt(own(0, 0)) / lag;  // relative
  const double resonance = 1.0 / (2.0 * std::numbers::pi * std::sqrt(term.drive.lag));
  const sim::Drive drive(model);
  // The motion of the motor determines the ratio of the table's friction to its inertia; the friction comes from the
  // model. Bearings and seals of the motor have a tenth of the friction of a drive, with an uncertainty of the same
  // size (textbook).
  constexpr double kMotorsFriction = 0.1;
  const double friction = 0.5 * (drive.friction[0].coulomb + drive.friction[1].coulomb) * (1.0 - kMotorsFriction);
  if (friction > 0.0) {
    const bool rotary = model.data.kind == sim::DriveKind::rotary;
    const double value = lag * term.drive.deceleration / friction;
    const double off = value * std::hypot(lag_off, std::sqrt(own(1, 1)), kMotorsFriction);
    effect.sizes.push_back(size("compliance", rotary ? "um/Nm" : "um/N", value, off));
    const double force = 1e-3 * model.data.lead;  // Nm per N
    if (rotary) effect.sizes.push_back(size("compliance_by_force", "um/N", value * force, off * force));
  }
  effect.sizes.push_back(size("resonance", "Hz", resonance, 0.5 * resonance * lag_off));
  effect.words = fmt::format("compliance of {}", in_words(effect.sizes[0]));
}

}  // namespace

std::string place_of(const TableTerm& term, const TableRows& rows, const sim::DriveDescription& model) {
  const std::optional<int> part = part_of_a_turn(term.shape[0], rows, model.data.turn());
  return !part ? "scale" : *part <= kFewParts ? "motor" : "scale or motor";
}

bool stands_in(const sim::DriveDescription& model, std::string_view kind) {
  return kind != "encoder_cyclic_error" && model.find(kind) != nullptr;
}

void take_out_known(const sim::DriveDescription& model, TableRows& rows) {
  const sim::Drive drive(model);
  const double mm = model.data.kind == sim::DriveKind::linear ? 1e3 : 1.0;
  if (drive.encoder_error.empty() && drive.table_error.empty() && !(model.data.load_encoder_cyclic_period > 0.0) &&
      model.data.load_encoder_offset_per_K == 0.0)
    return;
  rows.y -= rows.means([&](const TableRecord& one) {
    std::vector<double> known(one.x.size());
    for (std::size_t k = 0; k < known.size(); ++k) {
      const double x = one.x[k] / mm;
      sim::DriveMotion motion;
      motion.x = motion.load_x = x;
      const double table = drive.table(motion, one.record->t_s[k]);
      known[k] =
          1e3 * mm *
          (table - x - drive.encoder_error_at(x) + model.data.load_encoder_error(table, warmer_K(*one.record, k)));
    }
    return known;
  });
}

MatrixXd factor_covariance(const EvidenceFit& fit, Index base, const std::vector<TableTerm>& terms,
                           const TableRows& rows, double usual) {
  const Index known = fit.factors.size();
  const MatrixXd inverse = fit.information.solve(MatrixXd::Identity(fit.whitened.cols(), fit.whitened.cols()));
  // After a reversal, model errors are correlated over the whole stroke, so strokes are the clusters (cluster-robust;
  // Liang and Zeger, Biometrika 73 (1986) 13-22). The result is at least the uncertainty due to noise.
  MatrixXd scores(0, fit.whitened.cols());
  for (Index k = 0; k < rows.size(); ++k) {
    const bool begins = k == 0 || rows.way(k) != rows.way(k - 1) ||
                        std::ranges::any_of(rows.runs, [k](const RowRun& run) { return run.first == k; });
    if (begins) {
      scores.conservativeResize(scores.rows() + 1, Eigen::NoChange);
      scores.bottomRows(1).setZero();
    }
    scores.bottomRows(1) += fit.weights(k) * fit.residual(k) * fit.whitened.row(k);
  }
  const auto strokes = static_cast<double>(scores.rows());
  const MatrixXd spread = scores * inverse * std::sqrt(strokes / std::max(1.0, strokes - 1.0));
  VectorXd deviations = VectorXd::Ones(known);
  Index first = base;
  for (const TableTerm& term : terms) {
    const MatrixXd own = term.slopes(rows);
    deviations.segment(first, own.cols()) = term.deviations(own, usual);
    first += own.cols();
  }
  for (Index c = 0; c < known; ++c)
    deviations(c) *= std::sqrt(std::max(1.0, spread.col(c).squaredNorm() / inverse(c, c)));
  return deviations.asDiagonal() * inverse.topLeftCorner(known, known) * deviations.asDiagonal();
}

TableEffect table_effect(const TableTerm& term, const EvidenceFit& fit, const MatrixXd& covariance, Index first,
                         const TableRows& rows, const sim::DriveDescription& model) {
  const bool rotary = model.data.kind == sim::DriveKind::rotary;
  const double to_unit = rotary ? 1e-3 : 1e-6;  // um to the model's unit
  const Index count = term.count(rows);
  const VectorXd factors = fit.factors.segment(first, count);
  const MatrixXd own = covariance.block(first, first, count, count);
  TableEffect effect;
  effect.entry.kind = term.kind;
  if (term.kind == "backlash") {
    effect.sizes.push_back(size("gap", "um", 1e3 * term.drive.gap, std::sqrt(own(0, 0))));
    effect.words = fmt::format("backlash of {}", in_words(effect.sizes[0]));
  } else if (term.kind == "compliance") {
    fill_compliance(term, own, model, effect);
  } else if (term.kind == "pitch_error") {
    fill_pitch(term, factors, own, rows, to_unit, effect);
  } else if (term.kind == "encoder_cyclic_error") {
    const std::optional<int> part = part_of_a_turn(term.shape[0], rows, model.data.turn());
    effect.place = place_of(term, rows, model);
    effect.sizes.push_back(amplitude_of("amplitude", factors, own));
    effect.sizes.push_back({"period", "mm", term.shape[0], {term.shape[0], term.shape[0]}});
    effect.words =
        fmt::format("cyclic error of {} every {:.5g} mm{}", in_words(effect.sizes[0]), term.shape[0],
                    !part                ? ": of the scale, because it is not a fraction of a motor turn"
                    : *part == 1         ? ", once a motor turn: of the motor's encoder or of the screw"
                    : *part <= kFewParts ? fmt::format(", {} times a motor turn: of the motor's encoder", *part)
                                         : fmt::format(", {} times a motor turn: of the scale or of the motor's "
                                                       "encoder; a scale with another grating would tell",
                                                       *part));
    const double sign = effect.place == "motor" ? -to_unit : to_unit;
    effect.entry.parameters = {
        {"cosine", sign * factors(0)}, {"sine", sign * factors(1)}, {"period", 1e3 * to_unit * term.shape[0]}};
  } else {
    // An effect that is equal over the whole travel cannot be located.
    constexpr std::string_view kWhere =
        ": of the screw, of its bearing or of the scale's own mount; a thermometer on each can tell them apart";
    Index most = 0;
    factors.cwiseAbs().maxCoeff(&most);
    const double deviation = std::sqrt(own(most, most));
    if (!term.is_of_the_record()) {
      effect.sizes.push_back(size("growth", "um/K", factors(0), deviation));
      effect.words = fmt::format("thermal growth of {}{}", in_words(effect.sizes[0]), kWhere);
      return effect;
    }
    effect.sizes.push_back(size("growth", "um", factors(most), deviation));
    effect.words = fmt::format("thermal growth towards {} with a time constant of {:.3g} s{}",
                               in_words(effect.sizes[0]), term.shape[0], kWhere);
    effect.entry.parameters = {{"growth", to_unit * factors(most)}, {"time_constant", term.shape[0]}};
  }
  return effect;
}

std::string table_words(const TableStudy& study) {
  if (study.empty()) return {};
  std::vector<std::string> parts;
  for (const TableEffect& effect : study.effects)
    parts.push_back(
        effect.words +
        (effect.group.size() > 1 ? fmt::format(" (or {}: these records cannot tell)", spaced(effect.group[1])) : "") +
        (effect.worth_naming ? "" : " (certain, but too small to matter here)"));
  if (parts.empty())
    return fmt::format("The table follows the motor's encoder within {:.3g} um RMS; no effect is found between them.",
                       study.before_um);
  return fmt::format("Measured on the table (x2 - x): {}. Together they reduce x2 - x from {:.3g} to {:.3g} um RMS.",
                     fmt::join(parts, "; "), study.before_um, study.left_um);
}

nlohmann::json table_json(const TableStudy& study) {
  nlohmann::json found = nlohmann::json::array();
  for (const TableEffect& effect : study.effects) {
    nlohmann::json sizes = nlohmann::json::object(), curve = nlohmann::json::array();
    for (const TableSize& one : effect.sizes)
      sizes[one.name] = {{"value", one.value}, {"unit", one.unit}, {"ci95", one.ci95}};
    for (const TablePoint& point : effect.curve)
      curve.push_back({{"x_mm", point.x_mm}, {"um", point.um}, {"sd_um", point.deviation_um}});
    found.push_back({{"kinds", effect.group},
                     {"worth_naming", effect.worth_naming},
                     {"probability", effect.probability},
                     {"rms_um", {{"without", effect.before}, {"with", effect.after}}},
                     {"sizes", std::move(sizes)},
                     {"words", effect.words}});
    if (!effect.place.empty()) found.back()["place"] = effect.place;
    if (!curve.empty()) found.back()["curve"] = std::move(curve);
  }
  nlohmann::json absent = nlohmann::json::object();
  for (const auto& [kind, probability] : study.absent_odds) absent[kind] = probability;
  return {{"rms_um", study.before_um}, {"left_um", study.left_um},  {"noise_um", study.noise_um},
          {"delay_s", study.delay_s},  {"found", std::move(found)}, {"not_found", std::move(absent)}};
}

}  // namespace host
