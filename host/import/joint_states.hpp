// Joint states of ROS 2: messages of sensor_msgs/msg/JointState, as bags hold them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/import/log_file.hpp"

namespace host {

inline constexpr std::string_view kJointStateType = "sensor_msgs/msg/JointState";

/// The units of their columns, by the definition of the message: which of the two holds depends on the joint.
inline constexpr std::string_view kJointPositionUnit = "rad or m", kJointSpeedUnit = "rad/s or m/s",
                                  kJointEffortUnit = "Nm or N";

/// What a bag says of one of its topics.
struct BagTopic {
  std::string name, type, encoding;

  bool has_joint_states() const { return type == kJointStateType && encoding == "cdr"; }
};

/// Collects the messages of a bag.
class JointStates {
 public:
  explicit JointStates(std::string_view path) : path_(path) {}

  /// One message, in CDR with its encapsulation header; `received_ns` counts where its own stamp is zero. Throws
  /// Failure (bad_input) where it is damaged, or with it the log grows too large.
  void add(const std::string& topic, std::string_view message, std::int64_t received_ns);

  /// A column for each quantity of each joint. Throws Failure (bad_input) that lists the bag's topics where none of
  /// them has joint states.
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
