#include "host/opening/understanding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "host/opening/axis_study.hpp"
#include "host/opening/channel_physics.hpp"
#include "host/opening/known_tools.hpp"
#include "host/record/columns.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// No controller's log has more columns. A larger log is not searched.
constexpr std::size_t kMostColumns = 2'000;

bool is_matrix(const Log& log) {
  return log.layout == "mat" || log.layout == "npy" || log.layout == "npz" || log.layout == "hdf5";
}

/// Replaces each gap by the value before it, only for the comparison of channels; gaps in a record are not filled in
/// this way.
std::vector<double> without_gaps(std::vector<double> values) {
  const auto first = std::ranges::find_if(values, [](double value) { return std::isfinite(value); });
  double last = first == values.end() ? 0.0 : *first;
  for (double& value : values) value = last = std::isfinite(value) ? value : last;
  return values;
}

Log for_comparing(const Log& log) {
  Log plain = log;
  for (LogColumn& column : plain.columns) column.values = without_gaps(std::move(column.values));
  return plain;
}

class Understander {
 public:
  Understander(const Log& log, const std::vector<const Log*>& group, const OpeningHints& hints)
      : raw_(log), log_(for_comparing(log)), hints_(hints) {
    std::size_t numbers = 0;
    for (const LogColumn& column : log.columns) numbers += column.values.size();
    constexpr std::size_t kMostNumbers = 2'000'000;  // copies of larger logs would fill the memory
    for (const Log* sibling : group)
      if (sibling != &log && numbers < kMostNumbers) copies_.push_back(for_comparing(*sibling));
    group_.push_back(&log_);
    for (const Log& copy : copies_) group_.push_back(&copy);
  }

  Understanding run() {
    found_.layout = log_.layout;
    if (log_.columns.size() > kMostColumns) {
      found_.missing.push_back(
          fmt::format("a log may have at most {} channels; this one has {}", kMostColumns, log_.columns.size()));
      return std::move(found_);
    }
    read_names();
    find_clock();
    split_axes();
    for (auto& [name, channels] : axes_) study(name, std::move(channels));
    list_unknown();
    for (const OpenedAxis& axis : found_.axes)
      for (const std::string& text : axis.missing)
        found_.missing.push_back(axis.name.empty() ? text : fmt::format("{}: {}", axis.name, text));
    return std::move(found_);
  }

 private:
  void read_names() {
    found_.channels.resize(log_.columns.size());
    for (std::size_t k = 0; k < log_.columns.size(); ++k) {
      found_.channels[k].name = log_.columns[k].name.empty() ? fmt::format("#{}", k + 1) : log_.columns[k].name;
      names_.push_back(understand_name(log_.columns[k]));
      const std::string& name = log_.columns[k].name;
      if (is_matrix(log_) && name.ends_with(')') && name.find('(') != std::string::npos && log_.columns[k].unit.empty())
        names_.back() = {};  // the name of a matrix
      if (const KnownColumn* known = find_known_column(name)) {
        names_.back().axis.clear();
        names_.back().is_second = known->channel == &Record::x2;
      }
      if (name == "u_V") names_.back().is_reference = true;  // the name of the command in a record
    }
    apply_known_tools(log_, names_);
    found_.layout = log_.layout;
  }

  /// The stamps of the rows: a column named as time, or a column without another meaning that counts evenly.
  void find_clock() {
    const LogColumn* stamps = nullptr;
    std::size_t at = 0;
    std::ptrdiff_t most = -1;  // of several stamps, uses those with the most channels
    for (std::size_t k = 0; k < log_.columns.size(); ++k) {
      if (!raw_.columns[k].fault.empty() || raw_.columns[k].values.size() < 2 || is_constant(raw_.columns[k].values))
        continue;
      const std::ptrdiff_t channels =
          raw_.columns[k].name.empty() ? 0 : std::ranges::count(log_.columns, raw_.columns[k].name, &LogColumn::time);
      if (channels == 0 && (names_[k].quantity != ChannelQuantity::time || !raw_.columns[k].time.empty())) continue;
      names_[k].quantity = ChannelQuantity::time;
      found_.channels[k].why = "time stamps";
      found_.channels[k].sure = kSureEnough;
      if (channels > most) stamps = &raw_.columns[at = k];
      most = std::max(most, channels);
    }
    for (std::size_t k = 0; k < log_.columns.size() && stamps == nullptr; ++k)
      if (raw_.columns[k].time.empty() && names_[k].quantity == ChannelQuantity::unknown && rises(log_.columns[k]) &&
          !is_counter(k))
        stamps = &raw_.columns[at = k];
    const ChannelName* name = stamps == nullptr ? nullptr : &names_[at];
    found_.time = time_base_of(log_, stamps, name, hints_.period_s);
    if (stamps == nullptr && found_.time.source.empty()) {
      found_.missing.push_back(
          "the time base: the file has no time column and no sampling period; give --period SECONDS");
    } else if (found_.time.source.empty()) {
      found_.missing.push_back(
          fmt::format("the unit of the times in '{}'; give --map t_s={}*…", stamps->name, source_text(stamps->name)));
    }
    if (found_.time.period_s > 0.0) found_.rate_Hz = 1.0 / found_.time.period_s;
    if (stamps == nullptr) return;
    stamps_ = stamps->name;
    OpenedChannel& channel = found_.channels[at];
    channel.taken_as = found_.time.source.empty() ? "" : "t_s";
    const double factor = found_.time.source == kRowSource && name->unit ? name->unit->factor : found_.time.factor;
    channel.factor = found_.time.source == kRowSource && !name->unit ? 1.0 : factor;
    channel.why = found_.time.why;
    channel.sure = found_.time.sure;
    names_[at].quantity = ChannelQuantity::time;
    if (channel.sure < kSureEnough && !channel.taken_as.empty())
      found_.asks.push_back(
          fmt::format("times in {}: {}? If not, give --period SECONDS", source_text(stamps_), channel.why));
  }

  static bool rises(const LogColumn& column) {
    return column.fault.empty() && column.values.size() > 2 &&
           std::ranges::adjacent_find(column.values, std::ranges::greater_equal()) == column.values.end();
  }

  /// A column that has no name and counts by one is a row number.
  bool is_counter(std::size_t k) const {
    const std::vector<double>& values = log_.columns[k].values;
    return !is_matrix(log_) && log_.columns[k].name.empty() && is_ramp(values) &&
           std::abs(values[1] - values[0] - 1.0) < 1e-9;
  }

  /// Groups the channels by axis. If the names contain one axis or none, all channels belong together.
  void split_axes() {
    std::set<std::string> tags;
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (names_[k].quantity == ChannelQuantity::position || names_[k].quantity == ChannelQuantity::speed ||
          names_[k].quantity == ChannelQuantity::current || names_[k].quantity == ChannelQuantity::torque)
        if (!names_[k].is_reference && !names_[k].axis.empty()) tags.insert(names_[k].axis);
    const bool several = tags.size() > 1;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (names_[k].quantity == ChannelQuantity::time) continue;
      const bool belongs = several && tags.contains(names_[k].axis);
      axes_[belongs ? names_[k].axis : ""].push_back({k, names_[k]});
    }
    if (!several) return;
    // A channel without an axis name belongs to one of the axes or to none. It does not become a record of its own.
    const auto rest = axes_.find("");
    if (rest == axes_.end()) return;
    for (const NamedChannel& channel : rest->second) {
      OpenedChannel& out = found_.channels[channel.column];
      out.why =
          channel.name.quantity == ChannelQuantity::unknown
              ? "not recognised; left out"
              : fmt::format("{}, but its name does not assign it to an axis", quantity_name(channel.name.quantity));
      const bool effort =
          channel.name.quantity == ChannelQuantity::current || channel.name.quantity == ChannelQuantity::torque ||
          channel.name.quantity == ChannelQuantity::voltage || channel.name.quantity == ChannelQuantity::force;
      if (effort && !is_constant(log_.columns[channel.column].values))
        found_.asks.push_back(fmt::format(
            "the axis of '{}' ({}), which its name does not contain: give --map with the columns of one axis", out.name,
            quantity_name(channel.name.quantity)));
    }
    axes_.erase(rest);
  }

  /// An axis keeps its own rate if all its channels have the same stamps and these differ from the log's stamps.
  void take_own_stamps(const std::vector<NamedChannel>& channels, OpenedAxis& axis) {
    const std::string& stamps = log_.columns[channels.front().column].time;
    const bool own = !stamps.empty() && stamps != stamps_ && !hints_.period_s &&
                     std::ranges::all_of(channels, [&](const NamedChannel& channel) {
                       return log_.columns[channel.column].time == stamps;
                     });
    if (!own || axes_.size() < 2) return;
    const auto at = static_cast<std::size_t>(&raw_.find(stamps) - raw_.columns.data());
    TimeBase time = time_base_of(log_, &raw_.columns[at], &names_[at], {});
    if (time.source.empty()) return;
    OpenedChannel& clock = found_.channels[at];
    clock = {clock.name, axis.name, "t_s", time.factor, 0.0, time.why, time.sure};
    axis.stamps = stamps;
    axis.own_time = std::move(time);
  }

  void study(const std::string& name, std::vector<NamedChannel> channels) {
    OpenedAxis axis;
    axis.name = name;
    axis.stamps = stamps_;
    take_own_stamps(channels, axis);
    AxisStudy(group_, log_, hints_, time_of(axis, found_).period_s).run(std::move(channels), axis, found_);
    axis.makes_record = axis.makes_record && !time_of(axis, found_).source.empty();
    found_.axes.push_back(std::move(axis));
  }

  /// For columns without a meaningful name, lists the possible quantities according to their relations.
  void list_unknown() {
    constexpr std::size_t kMost = 16;
    std::vector<std::size_t> unknown;
    for (std::size_t k = 0; k < names_.size() && unknown.size() < kMost; ++k)
      if (names_[k].quantity == ChannelQuantity::unknown && log_.columns[k].fault.empty() &&
          !is_constant(log_.columns[k].values))
        unknown.push_back(k);
    if (!(found_.time.period_s > 0.0)) return;
    for (const std::size_t position : unknown)
      for (const std::size_t speed : unknown) {
        if (position == speed || log_.columns[position].time != log_.columns[speed].time) continue;
        const auto change =
            change_over_speed(log_.columns[position].values, log_.columns[speed].values, found_.time.period_s);
        if (change && change->r_squared > 0.99 && std::abs(change->factor - 1.0) < 0.03)
          may_be(position, speed, unknown);
      }
  }

  void may_be(std::size_t position, std::size_t speed, const std::vector<std::size_t>& unknown) {
    std::string efforts;
    for (const std::size_t k : unknown) {
      const auto share = k == position || k == speed
                             ? std::nullopt
                             : effort_by_motion(log_.columns[position].values, log_.columns[k].values);
      if (share && *share > 0.5)
        efforts += fmt::format("{}{} ({:.0f} %)", efforts.empty() ? "" : ", ", found_.channels[k].name, 100.0 * *share);
    }
    found_.asks.push_back(fmt::format(
        "'{}' may be the speed of the position '{}' (its integral){}: give --map x_mm=…", found_.channels[speed].name,
        found_.channels[position].name,
        efforts.empty()
            ? ""
            : fmt::format("; possible torque, force or current, by the share that the motion explains: {}", efforts)));
    found_.channels[position].why =
        fmt::format("may be a position: '{}' is its derivative", found_.channels[speed].name);
    found_.channels[speed].why = fmt::format("may be a speed: the derivative of '{}'", found_.channels[position].name);
    found_.channels[position].sure = found_.channels[speed].sure = 0.4;
  }

  const Log& raw_;
  Log log_;  ///< the log with gaps filled
  const OpeningHints& hints_;
  std::vector<Log> copies_;
  std::vector<const Log*> group_;
  std::vector<ChannelName> names_;
  std::map<std::string, std::vector<NamedChannel>> axes_;
  std::string stamps_;
  Understanding found_;
};

}  // namespace

std::string source_text(const std::string& name) {
  const bool plain = std::ranges::all_of(name, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalnum(byte) != 0 || c == '_' || c == '.' || byte >= 0x80;
  });
  const bool digit = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) != 0;
  if ((plain && !digit) || name.starts_with('#')) return name;
  return name.find('"') == std::string::npos ? fmt::format("\"{}\"", name) : fmt::format("'{}'", name);
}

std::string mapping_text(const Mapping& mapping) {
  return fmt::format("{}={}{}{}{}", mapping.column, source_text(mapping.source),
                     mapping.factor == 1.0 ? "" : fmt::format("*{}", mapping.factor),
                     mapping.shift == 0.0 ? "" : fmt::format("{:+}", mapping.shift),
                     mapping.time_source.empty() ? "" : fmt::format("@{}", source_text(mapping.time_source)));
}

void decode_signs(Log& log) {
  for (LogColumn& column : log.columns)
    if (const auto bit = column.fault.empty() ? sign_bit(column.values) : std::nullopt) {
      column.values = without_sign_bit(std::move(column.values), *bit);
      log.header["imported_sign_" + column.name] = fmt::format("bit {} is the sign of a magnitude", *bit);
      column.kind += fmt::format(", bit {} was the sign", *bit);
    }
}

Understanding understand(const Log& log, const std::vector<const Log*>& group, const OpeningHints& hints) {
  return Understander(log, group, hints).run();
}

}  // namespace host
