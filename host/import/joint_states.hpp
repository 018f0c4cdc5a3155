// Joint states of ROS 2: messages sensor_msgs/msg/JointState in bags.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/import/log_file.hpp"

namespace host {

inline constexpr std::string_view kJointStateType = "sensor_msgs/msg/JointState";

/// The units of the columns, by the definition of the message. Which of the two applies depends on the joint.
inline constexpr std::string_view kJointPositionUnit = "rad or m", kJointSpeedUnit = "rad/s or m/s",
                                  kJointEffortUnit = "Nm or N";

/// Description of one topic in a bag.
struct BagTopic {
  std::string name, type, encoding;

  bool has_joint_states() const { return type == kJointStateType && encoding == "cdr"; }
};

/// Collects the joint messages of a bag.
class JointStates {
 public:
  explicit JointStates(std::string_view path) : path_(path) {}

  /// Adds one message in CDR with its encapsulation header. `received_ns` is used if the message has no stamp. Throws
  /// Failure(bad_input) if it is damaged, or if the log becomes too large.
  void add(const std::string& topic, std::string_view message, std::int64_t received_ns);

  /// The log with a column for each quantity of each joint. Throws Failure(bad_input), with the list of the bag's
  /// topics, if none of them has joint states.
  Log log(const std::vector<BagTopic>& topics) const;

 private:
  struct Joint {
    std::vector<double> time_s, position, speed, effort;
  };

  std::string path_;
  std::map<std::string, std::map<std::string, Joint>> topics_;
  std::size_t messages_ = 0, numbers_ = 0, joints_ = 0;
  std::int64_t first_ns_ = 0;
};

}  // namespace host
