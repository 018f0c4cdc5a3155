// Joints of robots, for which the log does not say whether they turn or slide.
#include <fmt/format.h>

#include "host/import/joint_states.hpp"
#include "host/opening/axis_study.hpp"

namespace host {

/// The data sheet determines whether a joint turns or slides. Without a data sheet, the joint is assumed to turn.
void AxisStudy::settle_joint() {
  const bool slides = hints_.sheet && hints_.sheet->kind != sim::DriveKind::rotary;
  for (NamedChannel& channel : channels_) {
    ChannelName& name = channel.name;
    if (!name.sliding_unit) continue;
    if (slides) name.unit = name.sliding_unit;
    if (slides && name.quantity == ChannelQuantity::torque) name.quantity = ChannelQuantity::force;
    may_slide_ = !hints_.sheet;
    const std::size_t choice = name.unit_text.find(" or ");
    name.unit_text =
        fmt::format("{} ({} by {}; {})", slides ? name.unit_text.substr(choice + 4) : name.unit_text.substr(0, choice),
                    name.unit_text, kJointStateType,
                    hints_.sheet ? fmt::format("the data sheet's drive is {}", slides ? "linear" : "rotary")
                                 : "taken as a joint that turns");
  }
}

void AxisStudy::ask_of_joint() {
  std::string turning, sliding;
  for (const NamedChannel& channel : channels_)
    for (const Mapping& mapping : axis_->mappings) {
      const LogColumn& column = log_.columns[channel.column];
      if (!may_slide_ || !channel.name.sliding_unit || mapping.source != column.name) continue;
      Mapping other = mapping;
      other.column = mapping.column == "w_rad_s" ? "v_mm_s" : mapping.column;
      other.factor *= channel.name.sliding_unit->factor;
      turning += fmt::format("{}{} in {}", turning.empty() ? "" : ", ", quoted(channel), column.unit);
      sliding += fmt::format("{}{}", sliding.empty() ? "" : ",", mapping_text(other));
    }
  if (!turning.empty())
    ask(fmt::format("{}does the joint turn (rad, Nm)? The bag does not say: {}. If it slides (m, N), give --map {}",
                    axis_->name.empty() ? "" : axis_->name + ": ", turning, sliding));
}

}  // namespace host
