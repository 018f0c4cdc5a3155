#include "host/path/path_curve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace host {

PathCurve PathCurve::line(const PathPoint& begin, const PathPoint& end) {
  PathCurve curve;
  curve.begin_ = begin;
  curve.end_ = end;
  curve.length_ = (end - begin).norm();
  return curve;
}

PathCurve PathCurve::arc(const PathPoint& begin, const PathPoint& centre, double angle, double end_z) {
  PathCurve curve;
  curve.kind_ = Kind::arc;
  curve.begin_ = begin;
  curve.centre_ = centre;
  curve.centre_.z() = begin.z();
  curve.angle_ = angle;
  curve.end_.z() = end_z;
  const double radius = (begin - curve.centre_).norm();
  curve.length_ = std::hypot(radius * angle, end_z - begin.z());
  curve.end_ = curve.at(curve.length_).point;
  return curve;
}

PathCurve PathCurve::blend(const CurveState& begin, const CurveState& end, double reach) {
  PathCurve curve;
  curve.kind_ = Kind::blend;
  const PathPoint first = reach * begin.tangent, second = reach * reach * begin.curvature;
  const PathPoint first_end = reach * end.tangent, second_end = reach * reach * end.curvature;
  // The derivatives at the ends of a Bezier curve of fifth degree are 5 (P1 - P0) and 20 (P2 - 2 P1 + P0).
  auto& p = curve.control_;
  p[0] = begin.point;
  p[1] = p[0] + first / 5.0;
  p[2] = second / 20.0 + 2.0 * p[1] - p[0];
  p[5] = end.point;
  p[4] = p[5] - first_end / 5.0;
  p[3] = second_end / 20.0 + 2.0 * p[4] - p[5];
  curve.begin_ = begin.point;
  curve.end_ = end.point;
  curve.measure();
  return curve;
}

namespace {

/// The value and its first two derivatives, by de Casteljau's algorithm.
struct BezierState {
  PathPoint value, first, second;
};
BezierState evaluate(const std::array<PathPoint, 6>& control, double u) {
  std::array<PathPoint, 6> p = control;
  BezierState state;
  for (std::size_t left = 5; left > 0; --left) {
    if (left == 2) state.second = 20.0 * (p[2] - 2.0 * p[1] + p[0]);
    if (left == 1) state.first = 5.0 * (p[1] - p[0]);
    for (std::size_t i = 0; i < left; ++i) p[i] = (1.0 - u) * p[i] + u * p[i + 1];
  }
  state.value = p[0];
  return state;
}

}  // namespace

void PathCurve::measure() {
  lengths_.assign(1, 0.0);
  for (std::size_t i = 0; i < kParts; ++i) {
    // Gauss quadrature with three points: exact to fifth degree, and the speed along the curve is smooth.
    const double middle = (static_cast<double>(i) + 0.5) / kParts, half = 0.5 / kParts;
    const double off = half * std::sqrt(0.6);
    const double sum = 5.0 * evaluate(control_, middle - off).first.norm() +
                       8.0 * evaluate(control_, middle).first.norm() +
                       5.0 * evaluate(control_, middle + off).first.norm();
    lengths_.push_back(lengths_.back() + sum * half / 9.0);
  }
  length_ = lengths_.back();
}

CurveState PathCurve::at_share(double share) const {
  const BezierState state = evaluate(control_, share);
  const double speed = state.first.norm();
  const PathPoint tangent = state.first / speed;
  return {state.value, tangent, (state.second - tangent * tangent.dot(state.second)) / (speed * speed)};
}

CurveState PathCurve::at(double length) const {
  if (kind_ == Kind::line) {
    const PathPoint tangent = length_ > 0.0 ? PathPoint((end_ - begin_) / length_) : PathPoint::Zero();
    return {begin_ + length * tangent, tangent, PathPoint::Zero()};
  }
  if (kind_ == Kind::arc) {
    const double share = length_ > 0.0 ? length / length_ : 0.0;
    const double turned = share * angle_, c = std::cos(turned), s = std::sin(turned);
    const PathPoint from = begin_ - centre_;
    const PathPoint out(c * from.x() - s * from.y(), s * from.x() + c * from.y(), 0.0);
    const double turns = angle_ / length_;
    PathPoint point = centre_ + out;
    point.z() += share * (end_.z() - begin_.z());
    return {point, {-turns * out.y(), turns * out.x(), (end_.z() - begin_.z()) / length_}, -turns * turns * out};
  }
  // The parameter from the table, then Newton steps on the length within its part.
  const double wanted = std::clamp(length, 0.0, length_);
  const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, wanted);
  const auto part = static_cast<std::size_t>(next - lengths_.begin()) - 1;
  const double whole = lengths_[part + 1] - lengths_[part];
  double inside = whole > 0.0 ? (wanted - lengths_[part]) / whole : 0.0;
  for (int k = 0; k < 2; ++k) {
    // Simpson's rule from the beginning of the part.
    const double from = static_cast<double>(part) / kParts, width = inside / kParts;
    const double here = evaluate(control_, from + width).first.norm();
    const double reached =
        width / 6.0 *
        (evaluate(control_, from).first.norm() + 4.0 * evaluate(control_, from + width / 2.0).first.norm() + here);
    inside += (wanted - lengths_[part] - reached) / here * kParts;
  }
  return at_share(std::clamp((static_cast<double>(part) + inside) / kParts, 0.0, 1.0));
}

double PathCurve::distance_to(const PathPoint& point) const {
  if (kind_ == Kind::line) {
    if (length_ == 0.0) return (point - begin_).norm();
    const double along = std::clamp((point - begin_).dot(end_ - begin_) / length_, 0.0, length_);
    return (point - at(along).point).norm();
  }
  if (kind_ == Kind::arc) {
    const double start = std::atan2(begin_.y() - centre_.y(), begin_.x() - centre_.x());
    const double seen = std::atan2(point.y() - centre_.y(), point.x() - centre_.x());
    double turned = std::remainder(seen - start, 2.0 * std::numbers::pi);
    if (turned * angle_ < 0.0) turned += std::copysign(2.0 * std::numbers::pi, angle_);
    double nearest = std::min((point - begin_).norm(), (point - end_).norm());
    // For a helix, the turn nearest in height; exact if it does not rise.
    for (; std::abs(turned) <= std::abs(angle_); turned += std::copysign(2.0 * std::numbers::pi, angle_))
      nearest = std::min(nearest, (point - at(turned / angle_ * length_).point).norm());
    return nearest;
  }
  double nearest = std::numeric_limits<double>::infinity();
  PathPoint last = control_[0];
  for (std::size_t i = 1; i <= kParts; ++i) {
    const PathPoint next = evaluate(control_, static_cast<double>(i) / kParts).value;
    nearest = std::min(nearest, line(last, next).distance_to(point));
    last = next;
  }
  return nearest;
}

double PathCurve::turning() const {
  if (kind_ == Kind::line) return 0.0;
  if (kind_ == Kind::arc) return std::abs(angle_);
  double sum = 0.0;
  for (std::size_t i = 0; i < kParts; ++i)
    sum += at_share((static_cast<double>(i) + 0.5) / kParts).curvature.norm() * (lengths_[i + 1] - lengths_[i]);
  return sum;
}

PathCurve PathCurve::part(double from, double to) const {
  if (kind_ == Kind::line) {
    PathCurve cut = line(at(from).point, to == length_ ? end_ : at(to).point);
    return cut;
  }
  const CurveState begin = at(from);
  const double share = (to - from) / length_;
  return arc(begin.point, centre_, angle_ * share, begin.point.z() + share * (end_.z() - begin_.z()));
}

}  // namespace host
