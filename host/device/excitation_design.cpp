// Converts an experiment's kind, numbers and box to the board's request.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include "host/device/excitation.hpp"
#include "host/device/quantity.hpp"
#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"

namespace host {

const std::array<ExcitationKindText, 8> kExcitationKindTexts{{
    {"steps", "voltage levels in both directions, each until the box makes the axis reverse", "[V …] hold=S"},
    {"ramp", "voltage that rises slowly until the axis breaks away, in both directions", "amplitude=V time=S"},
    {"sine", "a sine", "amplitude=V|mm frequency=HZ ride=MM/S"},
    {"chirp", "a sine whose frequency rises", "amplitude=V|mm from=HZ to=HZ ride=MM/S"},
    {"multisine", "odd lines with random phases",
     "amplitude=V|mm (peak) from=HZ to=HZ lines=N period=SAMPLES ride=MM/S"},
    {"reversals", "triangles of the reference", "amplitude=MM speed=MM/S"},
    {"ladder", "jogs at a series of speeds, in both directions", "[MM/S …] hold=S"},
    {"dwell", "short jogs with increasing rests between them", "[S …] speed=MM/S hold=S"},
}};

namespace {

using firmware::ExcitationInput;
using firmware::ExcitationKind;

constexpr double kWholeTurn = 4294967296.0;  // 2^32

class Designer {
 public:
  Designer(std::string_view kind, const ExcitationNumbers& numbers, const ExcitationLimits& box,
           const ExcitationScale& scale, std::string_view closed_loop, unsigned seed)
      : kind_(kind), numbers_(numbers), box_(box), scale_(scale), closed_loop_(closed_loop), seed_(seed) {}

  Excitation design() {
    put_box();
    if (kind_ == "steps")
      steps();
    else if (kind_ == "ramp")
      ramp();
    else if (kind_ == "sine" || kind_ == "chirp")
      chirp();
    else if (kind_ == "multisine")
      multisine();
    else if (kind_ == "reversals")
      reversals();
    else if (kind_ == "ladder")
      ladder();
    else if (kind_ == "dwell")
      dwell();
    else
      throw_unknown_kind();
    refuse_unknown_numbers();
    made_.header["excitation"] = std::string(kind_);
    made_.header["excitation_input"] = input_name();
    made_.header["excitation_box"] =
        fmt::format("travel={:g} speed={:g} volts={:g} time={:g}", box_.travel, box_.speed, box_.volts, box_.time_s);
    made_.summary = fmt::format("{}, {}: {}", kind_, input_name(), made_.summary);
    return made_;
  }

 private:
  [[noreturn]] void throw_unknown_kind() const {
    std::vector<std::string_view> known;
    for (const ExcitationKindText& text : kExcitationKindTexts) known.push_back(text.name);
    throw Failure(ExitCode::usage, fmt::format("no excitation is called {}{}; there are {}", kind_,
                                               did_you_mean(kind_, known), fmt::join(known, ", ")));
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw Failure(ExitCode::refused, fmt::format("{}: {}", kind_, what));
  }

  double number(const std::string& name, double otherwise) {
    known_.push_back(name);
    const auto found = numbers_.named.find(name);
    return found == numbers_.named.end() ? otherwise : found->second;
  }
  double positive(const std::string& name, double otherwise) {
    const double value = number(name, otherwise);
    if (!(value > 0.0) || !std::isfinite(value)) refuse(fmt::format("{} = {:g} must be above 0", name, value));
    return value;
  }
  void refuse_unknown_numbers() const {
    for (const auto& [name, value] : numbers_.named)
      if (std::ranges::find(known_, name) == known_.end())
        throw Failure(ExitCode::usage,
                      fmt::format("{} has no number called {}; it has {}", kind_, name, fmt::join(known_, ", ")));
    const bool takes_list = kind_ == "steps" || kind_ == "ladder" || kind_ == "dwell";
    if (!numbers_.list.empty() && !takes_list)
      throw Failure(ExitCode::usage,
                    fmt::format("write the numbers of {} by name: {}", kind_, fmt::join(known_, ", ")));
  }

  double samples(double seconds) const { return std::max(1.0, std::round(seconds * scale_.rate_Hz)); }
  std::uint32_t whole_samples(double seconds) const {
    return static_cast<std::uint32_t>(std::min(samples(seconds), 4e9));
  }
  double counts(double travel) const { return travel / scale_.encoder_resolution; }
  double counts_a_sample(double speed) const { return counts(speed) / scale_.rate_Hz; }
  double codes(double volts) const { return volts / scale_.dac_resolution_V; }
  bool is_open() const { return made_.request.input == static_cast<std::uint8_t>(ExcitationInput::open_loop); }

  void put_box() {
    firmware::ExcitationRequest& r = made_.request;
    const double half = counts(box_.travel) / 2.0;
    if (!(half >= 1.0) || half > firmware::kMostBoxCounts)
      refuse(fmt::format("travel = {:g} is too narrow for the encoder", box_.travel));
    r.travel_counts = static_cast<std::int32_t>(half);
    r.speed = static_cast<float>(counts_a_sample(box_.speed));
    if (!(r.speed * firmware::kSpeedSamples >= 2.0F) || r.speed > firmware::kMostSpeedCounts)
      refuse(fmt::format("speed = {:g} is {:g} counts per sample: the encoder cannot resolve it", box_.speed,
                         static_cast<double>(r.speed)));
    r.drive_velocity = static_cast<float>(!scale_.has_tachometer ? -1.0
                                          : scale_.lead > 0      ? box_.speed / scale_.lead
                                                                 : 0.0);
    r.volts = static_cast<float>(codes(box_.volts));
    r.samples = whole_samples(box_.time_s);
    r.period = r.fade_samples = 1;
  }

  void enter(ExcitationKind kind, ExcitationInput input) {
    made_.request.kind = static_cast<std::uint8_t>(kind);
    made_.request.input = static_cast<std::uint8_t>(input);
  }

  ExcitationInput chosen_input() const {
    if (closed_loop_.empty()) return ExcitationInput::open_loop;
    if (closed_loop_ == "reference") return ExcitationInput::reference;
    if (closed_loop_ == "output") return ExcitationInput::output;
    throw Failure(ExitCode::usage, fmt::format("--closed-loop {}: write reference or output", closed_loop_));
  }

  std::string input_name() const {
    constexpr std::array kNames{"open loop", "reference", "controller's output", "jog"};
    return kNames.at(made_.request.input);
  }

  void add_level(double value, double seconds) {
    if (made_.entries.size() == firmware::kExcitationEntries)
      refuse(fmt::format("more than {} levels", firmware::kExcitationEntries));
    made_.entries.push_back({static_cast<float>(value), whole_samples(seconds), 0});
    made_.request.count = static_cast<std::uint8_t>(made_.entries.size());
    made_.request.amplitude = std::max(made_.request.amplitude, std::abs(static_cast<float>(value)));
  }

  /// Steps of several sizes separate friction from inertia, because friction is a larger part of the small steps. Each
  /// step is large enough to brake the motion from the previous one.
  void steps() {
    enter(ExcitationKind::train, ExcitationInput::open_loop);
    std::vector<double> levels = numbers_.list;
    if (levels.empty())
      for (const double share : {1.0, 0.7, 0.5, 0.35})
        levels.insert(levels.end(), {share * box_.volts, -share * box_.volts});
    const double hold = positive("hold", 0.5);
    for (const double level : levels) {
      if (std::abs(level) > box_.volts) refuse(fmt::format("{:g} V is more than volts = {:g}", level, box_.volts));
      add_level(codes(level), hold);
    }
    made_.header["excitation_levels_V"] = fmt::format("{:g}", fmt::join(levels, " "));
    made_.summary = fmt::format("{:g} V in turn, at most {:g} s each", fmt::join(levels, ", "), hold);
  }

  void put_amplitude(double otherwise) {
    const bool is_reference = chosen_input() == ExcitationInput::reference;
    if (is_reference) otherwise = std::min(box_.travel / 8.0, 100.0 * scale_.encoder_resolution);
    amplitude_ = positive("amplitude", otherwise);
    const double most =
        is_reference ? static_cast<double>(firmware::kMostReferenceCounts) * scale_.encoder_resolution : box_.volts;
    if (amplitude_ > most) refuse(fmt::format("amplitude = {:g} is more than {:g}", amplitude_, most));
    if (is_reference && amplitude_ > box_.travel / 2.0) refuse("the amplitude does not fit the box's travel");
    made_.request.amplitude = static_cast<float>(is_reference ? counts(amplitude_) : codes(amplitude_));
    made_.header["excitation_amplitude"] = fmt::format("{:g}", amplitude_);
  }

  void ramp() {
    enter(ExcitationKind::ramp, ExcitationInput::open_loop);
    put_amplitude(box_.volts);
    const double time = positive("time", box_.time_s / 4.0);
    made_.request.period = whole_samples(time);
    made_.summary = fmt::format("up to {:g} V in {:g} s", amplitude_, time);
  }

  double frequency(const char* name, double otherwise) {
    const double value = positive(name, otherwise);
    if (value >= 0.45 * scale_.rate_Hz)
      refuse(fmt::format("{} = {:g} Hz is too near half the control rate of {:g} Hz", name, value, scale_.rate_Hz));
    return value;
  }
  std::uint32_t turns_a_sample(double frequency_Hz) const {
    return static_cast<std::uint32_t>(std::llround(frequency_Hz / scale_.rate_Hz * kWholeTurn));
  }

  void put_ride() {
    const double ride = number("ride", 0.0);
    if (ride != 0.0 && closed_loop_.empty())
      refuse("only a closed loop can be combined with a jog: --closed-loop reference or output");
    if (std::abs(ride) * 1.25 > box_.speed) refuse(fmt::format("ride = {:g} is too near the box's speed", ride));
    made_.request.ride = static_cast<float>(counts_a_sample(ride));
    if (ride == 0.0) return;
    put_margin(std::abs(ride));
    made_.header["excitation_ride"] = fmt::format("{:g}", ride);
  }

  /// Sets the margin inside the box: the stopping distance from a steady jog within the limits, including the samples
  /// until the stop begins.
  void put_margin(double speed) {
    if (!(scale_.acceleration > 0.0) || !(scale_.jerk > 0.0)) return;
    const double stop = speed * speed / (2.0 * scale_.acceleration) + speed * scale_.acceleration / (2.0 * scale_.jerk);
    made_.request.margin_counts = static_cast<std::int32_t>(counts(stop + 10.0 * speed / scale_.rate_Hz)) + 2;
    if (made_.request.margin_counts * 2 > made_.request.travel_counts)
      refuse(fmt::format("at {:g} a stop takes {:g}: travel = {:g} is too narrow", speed, stop, box_.travel));
  }

  void chirp() {
    enter(ExcitationKind::chirp, chosen_input());
    put_amplitude(0.5 * box_.volts);
    const bool is_sine = kind_ == "sine";
    const double from = frequency(is_sine ? "frequency" : "from", is_sine ? 5.0 : 1.0);
    const double to = is_sine ? from : frequency("to", std::min(100.0, scale_.rate_Hz / 8.0));
    made_.request.step = turns_a_sample(from);
    made_.request.last_step = turns_a_sample(to);
    made_.request.fade_samples = whole_samples(std::min(box_.time_s / 10.0, 0.1));
    put_ride();
    made_.header["excitation_from_Hz"] = fmt::format("{:g}", from);
    made_.header["excitation_to_Hz"] = fmt::format("{:g}", to);
    made_.summary = fmt::format("{:g} {}, {:g} to {:g} Hz", amplitude_, unit(), from, to);
  }

  std::string unit() const {
    if (chosen_input() != ExcitationInput::reference) return "V";
    return scale_.kind == sim::DriveKind::rotary ? "mm" : "m";
  }

  /// Uses only some of the odd harmonics, so that the other lines show the drive's nonlinearity. Phases are random; the
  /// signal is scaled to its peak.
  void multisine() {
    enter(ExcitationKind::multisine, chosen_input());
    put_amplitude(0.5 * box_.volts);
    const double from = frequency("from", 2.0);
    const double to = frequency("to", std::min(100.0, scale_.rate_Hz / 8.0));
    const auto period =
        static_cast<std::uint32_t>(positive("period", std::exp2(std::round(std::log2(scale_.rate_Hz)))));
    const auto most = static_cast<std::size_t>(positive("lines", static_cast<double>(firmware::kExcitationEntries)));
    if (most > firmware::kExcitationEntries) refuse(fmt::format("more than {} lines", firmware::kExcitationEntries));
    const std::vector<std::uint32_t> lines = odd_lines(from, to, period, most);
    if (lines.empty()) refuse("no odd line lies between from and to: a longer period has more of them");
    std::mt19937 random(seed_);
    std::vector<double> phase(lines.size());
    for (double& p : phase) p = static_cast<double>(random()) / kWholeTurn;
    double peak = 0.0;
    for (std::uint32_t k = 0; k < period; ++k) {
      double sum = 0.0;
      for (std::size_t i = 0; i < lines.size(); ++i)
        sum += std::sin(2.0 * std::numbers::pi *
                        (static_cast<double>(std::uint64_t{lines[i]} * k % period) / period + phase[i]));
      peak = std::max(peak, std::abs(sum));
    }
    const double each = amplitude_ / peak;
    const bool is_reference = chosen_input() == ExcitationInput::reference;
    for (std::size_t i = 0; i < lines.size(); ++i)
      made_.entries.push_back({static_cast<float>(is_reference ? counts(each) : codes(each)),
                               static_cast<std::uint32_t>(std::llround(kWholeTurn * lines[i] / period)),
                               static_cast<std::uint32_t>(phase[i] * kWholeTurn)});
    made_.request.count = static_cast<std::uint8_t>(lines.size());
    made_.request.period = period;
    made_.request.fade_samples = period;
    put_ride();
    made_.header["excitation_period_samples"] = std::to_string(period);
    made_.header["excitation_lines"] = fmt::format("{}", fmt::join(lines, " "));
    made_.header["excitation_line_amplitude"] = fmt::format("{:.9g}", each);
    made_.header["excitation_phases_turns"] = fmt::format("{:.6f}", fmt::join(phase, " "));
    made_.summary = fmt::format("{} odd lines from {:g} to {:g} Hz, period {} samples, {:.4g} {} each, {:g} at most",
                                lines.size(), from, to, period, each, unit(), amplitude_);
  }

  std::vector<std::uint32_t> odd_lines(double from, double to, std::uint32_t period, std::size_t most) const {
    std::vector<std::uint32_t> all;
    const double width = scale_.rate_Hz / period;
    for (auto line = static_cast<std::uint32_t>(std::ceil(from / width)); line * width <= to; ++line)
      if (line % 2 == 1) all.push_back(line);
    if (all.size() <= most) return all;
    std::vector<std::uint32_t> chosen;  // evenly spaced in the logarithm of the frequency
    for (std::size_t i = 0; i < most; ++i) {
      const double share = most > 1 ? static_cast<double>(i) / static_cast<double>(most - 1) : 0.0;
      const double wanted = all.front() * std::pow(static_cast<double>(all.back()) / all.front(), share);
      auto best = std::ranges::lower_bound(all, static_cast<std::uint32_t>(wanted));
      while (best != all.end() && !chosen.empty() && *best <= chosen.back()) ++best;
      if (best != all.end()) chosen.push_back(*best);
    }
    return chosen;
  }

  void reversals() {
    enter(ExcitationKind::triangle, ExcitationInput::reference);
    closed_loop_ = "reference";
    put_amplitude(0.0);
    const double speed = positive("speed", amplitude_ * 4.0);
    const double frequency_Hz = speed / (4.0 * amplitude_);
    if (frequency_Hz >= scale_.rate_Hz / 8.0) refuse("the triangles are too fast for the control rate");
    if (speed * 1.25 > box_.speed) refuse(fmt::format("speed = {:g} is too near the box's", speed));
    made_.request.step = made_.request.last_step = turns_a_sample(frequency_Hz);
    made_.request.fade_samples = whole_samples(std::min(box_.time_s / 10.0, 1.0 / frequency_Hz));
    made_.header["excitation_speed"] = fmt::format("{:g}", speed);
    made_.summary = fmt::format("+-{:g} {} at {:g} {}/s", amplitude_, unit(), speed, unit());
  }

  void ladder() {
    enter(ExcitationKind::train, ExcitationInput::jog);
    std::vector<double> speeds = numbers_.list;
    if (speeds.empty())
      for (const double share : {0.02, 0.05, 0.1, 0.2, 0.4, 0.7}) speeds.push_back(share * box_.speed);
    const double hold = positive("hold", box_.time_s / (2.0 * static_cast<double>(speeds.size())));
    for (const double speed : speeds) {
      if (!(speed > 0.0) || speed * 1.25 > box_.speed)
        refuse(fmt::format("{:g} is not a possible speed of a ladder within the box", speed));
      add_level(counts_a_sample(speed), hold);
      add_level(-counts_a_sample(speed), hold);
    }
    put_margin(*std::ranges::max_element(speeds));
    made_.header["excitation_speeds"] = fmt::format("{:g}", fmt::join(speeds, " "));
    made_.summary = fmt::format("{:g} both ways, at most {:g} s each", fmt::join(speeds, ", "), hold);
  }

  void dwell() {
    enter(ExcitationKind::train, ExcitationInput::jog);
    std::vector<double> rests = numbers_.list;
    if (rests.empty()) rests = {0.05, 0.1, 0.2, 0.5, 1.0, 2.0};
    const double speed = positive("speed", 0.2 * box_.speed);
    const double hold = positive("hold", 0.2);
    put_margin(speed);
    for (std::size_t i = 0; i < rests.size(); ++i) {
      if (!(rests[i] > 0.0)) refuse("rests are above 0 s");
      add_level(counts_a_sample(i % 2 == 0 ? speed : -speed), hold);
      add_level(0.0, rests[i]);
    }
    made_.header["excitation_rests_s"] = fmt::format("{:g}", fmt::join(rests, " "));
    made_.summary = fmt::format("at {:g}, with rests of {:g} s", speed, fmt::join(rests, ", "));
  }

  std::string_view kind_;
  const ExcitationNumbers& numbers_;
  const ExcitationLimits& box_;
  const ExcitationScale& scale_;
  std::string_view closed_loop_;
  unsigned seed_;
  double amplitude_ = 0.0;
  std::vector<std::string> known_;
  Excitation made_;
};

/// "20", "20mm", "100mm/s" in the drive's own unit (rotary: mm; linear: m).
double quantity(std::string_view name, std::string_view text, sim::DriveKind kind) {
  const std::optional<Quantity> written = parse_quantity(text);
  std::string unit = written ? written->unit : "";
  const bool is_length = name == "travel" || name == "speed";
  if (name == "speed" && unit.ends_with("/s")) unit.resize(unit.size() - 2);
  const bool is_own = unit.empty() || (name == "volts" && unit == "V") || (name == "time" && unit == "s");
  const double factor = is_own ? 1.0 : is_length ? length_factor(unit, kind) : 0.0;
  if (!written || factor == 0.0)
    throw Failure(ExitCode::usage, fmt::format("--box {}={}: not a number, or a unit of something else", name, text));
  return written->value * factor;
}

}  // namespace

ExcitationLimits parse_box(std::string_view text, sim::DriveKind kind) {
  std::map<std::string, double, std::less<>> sides;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find(','));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos)
      throw Failure(ExitCode::usage, fmt::format("--box {}: write travel=20,speed=100,volts=3,time=5", part));
    const std::string_view name = part.substr(0, equals);
    if (name != "travel" && name != "speed" && name != "volts" && name != "time")
      throw Failure(ExitCode::usage,
                    fmt::format("--box: no side is called {}; there are travel, speed, volts, time", name));
    sides[std::string(name)] = quantity(name, part.substr(equals + 1), kind);
  }
  for (const char* name : {"travel", "speed", "volts", "time"}) {
    const auto side = sides.find(name);
    if (side == sides.end())
      throw Failure(ExitCode::refused, fmt::format("the box has no {}: nothing moves without all of "
                                                   "--box travel=…,speed=…,volts=…,time=…",
                                                   name));
    if (!(side->second > 0.0) || !std::isfinite(side->second))
      throw Failure(ExitCode::refused, fmt::format("--box {} = {:g} must be above 0", name, side->second));
  }
  if (sides["time"] > 86400.0) throw Failure(ExitCode::refused, "--box time: more than a day");
  return {sides["travel"], sides["speed"], sides["volts"], sides["time"]};
}

ExcitationNumbers parse_numbers(const std::vector<std::string>& words) {
  ExcitationNumbers numbers;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string text = equals == std::string::npos ? word : word.substr(equals + 1);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value))
      throw Failure(ExitCode::usage, fmt::format("{} is no number", word));
    if (equals == std::string::npos)
      numbers.list.push_back(value);
    else
      numbers.named[word.substr(0, equals)] = value;
  }
  return numbers;
}

Excitation design_excitation(std::string_view kind, const ExcitationNumbers& numbers, const ExcitationLimits& box,
                             const ExcitationScale& scale, std::string_view closed_loop, unsigned seed) {
  return Designer(kind, numbers, box, scale, closed_loop, seed).design();
}

}  // namespace host
