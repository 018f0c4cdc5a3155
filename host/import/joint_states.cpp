#include "host/import/joint_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <tuple>

#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

/// Largest number of joints in a bag, over all topics; a robot has some dozen.
constexpr std::size_t kMostJoints = 1000;

/// Common Data Representation (OMG DDS-XTypes 1.3, 7.4). Numbers are aligned to their size after the encapsulation
/// header, which states their byte order.
class CdrReader {
 public:
  explicit CdrReader(std::string_view message) : bytes_(message) {
    constexpr std::size_t kHeader = 4;
    is_good_ = bytes_.size() >= kHeader && bytes_[0] == 0 && (bytes_[1] == 0 || bytes_[1] == 1);
    if (!is_good_) return;
    is_big_ = bytes_[1] == 0;
    bytes_.remove_prefix(kHeader);
  }

  bool is_good() const { return is_good_; }

  template <typename Number>
  Number number() {
    at_ += (sizeof(Number) - at_ % sizeof(Number)) % sizeof(Number);
    std::array<char, sizeof(Number)> raw{};
    if (!has(sizeof(Number))) return {};
    std::copy_n(bytes_.data() + at_, sizeof(Number), raw.begin());
    at_ += sizeof(Number);
    if (is_big_ != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
    return std::bit_cast<Number>(raw);
  }

  /// The length includes the terminating zero.
  std::string_view text() {
    const std::size_t size = number<std::uint32_t>();
    if (!has(size)) return {};
    const std::string_view text = bytes_.substr(at_, size);
    at_ += size;
    return text.substr(0, text.find('\0'));
  }

  /// Length of a sequence whose members take at least `size` bytes each.
  std::size_t count(std::size_t size) {
    const std::size_t count = number<std::uint32_t>();
    is_good_ = is_good_ && count <= kMostJoints;
    return has(count * size) ? count : 0;
  }

  std::vector<double> doubles() {
    std::vector<double> values(count(sizeof(double)));
    for (double& value : values) value = number<double>();
    return values;
  }

 private:
  bool has(std::size_t size) {
    is_good_ = is_good_ && at_ <= bytes_.size() && bytes_.size() - at_ >= size;
    return is_good_;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_good_ = false, is_big_ = false;
};

struct JointMessage {
  std::int64_t stamp_ns = 0;
  std::vector<std::string_view> names;
  std::vector<double> positions, speeds, efforts;
};

/// std_msgs/Header (time, frame), names, positions, velocities, efforts. Returns false if the message is damaged.
bool decode_joint_message(std::string_view bytes, JointMessage& message) {
  CdrReader reader(bytes);
  const std::int64_t second = reader.number<std::int32_t>();
  message.stamp_ns = 1'000'000'000 * second + reader.number<std::uint32_t>();
  reader.text();
  constexpr std::size_t kLeastText = 4;
  message.names.resize(reader.count(kLeastText));
  for (std::string_view& name : message.names) name = reader.text();
  message.positions = reader.doubles();
  message.speeds = reader.doubles();
  message.efforts = reader.doubles();
  return reader.is_good();
}

}  // namespace

void JointStates::add(const std::string& topic, std::string_view message, std::int64_t received_ns) {
  JointMessage read;
  if (!decode_joint_message(message, read))
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: message {} of topic {} is not a {} in CDR: damaged or compressed; "
                              "unpack the bag with ros2 bag convert, or save it again",
                              path_, messages_ + 1, topic, kJointStateType));
  numbers_ += 4 * read.names.size();
  if (numbers_ > kMostLogNumbers)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: more than {} numbers, the most that a log may have; cut the bag "
                              "with ros2 bag convert",
                              path_, kMostLogNumbers));
  const std::int64_t stamp_ns = read.stamp_ns != 0 ? read.stamp_ns : received_ns;
  if (messages_++ == 0) first_ns_ = stamp_ns;
  // Subtracts the first stamp before the conversion, because a double has steps of 0.2 us for times since 1970. Uses
  // unsigned numbers, because a damaged time may overflow.
  const auto since_ns =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(stamp_ns) - static_cast<std::uint64_t>(first_ns_));
  std::map<std::string, Joint>& joints = topics_[topic];
  const auto value = [](const std::vector<double>& values, std::size_t k) {
    return k < values.size() ? values[k] : std::numeric_limits<double>::quiet_NaN();
  };
  for (std::size_t k = 0; k < read.names.size(); ++k) {
    const auto [found, is_new] = joints.try_emplace(std::string(read.names[k]));
    joints_ += is_new ? 1 : 0;
    if (joints_ > kMostJoints)
      throw Failure(ExitCode::bad_input, fmt::format("{}: more than {} joints, the most that a log may have; keep the "
                                                     "topics of one robot with ros2 bag convert",
                                                     path_, kMostJoints));
    Joint& joint = found->second;
    joint.time_s.push_back(1e-9 * static_cast<double>(since_ns));
    joint.position.push_back(value(read.positions, k));
    joint.speed.push_back(value(read.speeds, k));
    joint.effort.push_back(value(read.efforts, k));
  }
}

Log JointStates::log(const std::vector<BagTopic>& topics) const {
  Log log;
  log.path = path_;
  log.layout = "ros2-joint-states";
  std::vector<std::string> clocks;
  for (const auto& [topic, joints] : topics_)
    for (const auto& [name, joint] : joints) {
      std::string prefix = topics_.size() > 1 ? fmt::format("{}/", topic) : "";
      if (prefix.starts_with('/')) prefix.erase(0, 1);
      const std::string joint_name = prefix + name;
      // Joints of the same messages have the same stamps.
      std::string clock;
      for (const std::string& known : clocks)
        if (log.find(known).values == joint.time_s) clock = known;
      if (clock.empty()) {
        clock = clocks.empty() ? "time" : fmt::format("{}.time", joint_name);
        clocks.push_back(clock);
        log.columns.push_back({clock, fmt::format("{} times, s", joint.time_s.size()), joint.time_s, {}, 0.0, "s"});
      }
      for (const auto& [quantity, values, unit] : {std::tuple{"position", &joint.position, kJointPositionUnit},
                                                   std::tuple{"velocity", &joint.speed, kJointSpeedUnit},
                                                   std::tuple{"effort", &joint.effort, kJointEffortUnit}})
        if (std::ranges::any_of(*values, [](double number) { return !std::isnan(number); }))
          log.columns.push_back({fmt::format("{}.{}", joint_name, quantity),
                                 fmt::format("{} numbers, {}, {}", values->size(), unit, topic),
                                 *values,
                                 {},
                                 0.0,
                                 std::string(unit),
                                 clock});
    }
  if (clocks.size() == 1)  // one clock for the whole log
    for (LogColumn& column : log.columns) column.time.clear();
  if (!log.columns.empty()) return log;
  constexpr std::size_t kListed = 30;
  std::string held;
  for (const BagTopic& topic : std::span(topics).first(std::min(topics.size(), kListed)))
    held += fmt::format("{}{} ({}, {})", held.empty() ? "" : ", ", topic.name, topic.type, topic.encoding);
  if (topics.size() > kListed) held += fmt::format(" and {} more", topics.size() - kListed);
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: a bag without messages of {} in CDR; it holds {}; record the joints with ros2 bag "
                            "record /joint_states",
                            path_, kJointStateType, held.empty() ? "no topics" : held));
}

}  // namespace host
