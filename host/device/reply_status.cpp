#include "host/device/reply_status.hpp"

#include <fmt/format.h>

#include <bit>

#include "firmware/app/parameters/parameter_check.hpp"
#include "firmware/app/protocol/update_messages.hpp"
#include "host/device/board_report.hpp"
#include "host/exit_codes.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

using firmware::Message;
using firmware::MessageType;
using firmware::Status;

[[noreturn]] void give_up(ExitCode code, const std::string& text) { throw Failure(code, text); }

[[noreturn]] void throw_problem(const Message& reply) {
  firmware::RefusedValuePayload problem;
  if (!reply.get(problem)) give_up(ExitCode::protocol, "the board refuses a value but does not say which");
  const firmware::ParameterKey key{problem.key};
  if (reply.type == firmware::reply_to(MessageType::start_excitation))
    give_up(
        ExitCode::refused,
        fmt::format("the axis is not fitted, and experiments on it must stay within {} = {:g}: choose a smaller box, "
                    "or raise the limit if the machine allows it (axistool set-params)",
                    full_name(key), std::bit_cast<float>(problem.bits)));
  if (reply.type == firmware::reply_to(MessageType::jog))
    give_up(ExitCode::refused,
            fmt::format("the axis is not homed, and jogs at most at {} = {:g}: `axistool home` first, or jog slower",
                        full_name(key), std::bit_cast<float>(problem.bits)));
  if (reply.status == Status::drive_enabled)
    give_up(ExitCode::refused,
            fmt::format("{} may change only while all drives are disabled: `axistool disable`", full_name(key)));
  if (reply.status == Status::unknown_parameter)
    give_up(ExitCode::protocol,
            fmt::format("the board does not know {}: flash the firmware that matches this axistool", full_name(key)));
  give_up(ExitCode::bad_input, describe(key, problem.kind, std::bit_cast<float>(problem.bits)));
}

[[noreturn]] void throw_outside_travel(const Message& reply) {
  firmware::RefusedValuePayload limit;
  if (!reply.get(limit)) give_up(ExitCode::refused, "the motion would leave the axis's travel");
  const firmware::ParameterKey key{limit.key};
  const auto place = firmware::place_of(key);
  const float value = std::bit_cast<float>(limit.bits);
  give_up(
      ExitCode::refused,
      fmt::format("the motion would lead beyond {} = {}: choose a target inside, or move the limit if the machine has "
                  "the room",
                  full_name(key), place ? value_text(info_at(*place), value) : fmt::format("{}", value)));
}

std::string refusal_text(const firmware::RefusedImagePayload& refused) {
  switch (refused.refusal) {
    case firmware::ImageRefusal::other_board:
      return fmt::format("it is for another board than {}", refused.board.data());
    case firmware::ImageRefusal::other_chip:
      return fmt::format("it is for another chip than {:#05x}", refused.chip_id);
    case firmware::ImageRefusal::other_layout:
      return "it was built for boards without boot code, or for later ones";
    case firmware::ImageRefusal::wrong_size:
      return fmt::format("it is incomplete, or larger than {} bytes", refused.capacity);
    case firmware::ImageRefusal::no_header:
      return "it arrived without its header: send it again";
    case firmware::ImageRefusal::wrong_crc:
      return "its checksum does not match: it is damaged, or was damaged in the transfer; send it again";
    case firmware::ImageRefusal::not_announced:
      return "another image arrived than was announced: is another program updating the board?";
    case firmware::ImageRefusal::none:
      break;
  }
  return fmt::format("cause number {}", static_cast<unsigned>(refused.refusal));
}

bool is_of_update(const Message& reply) {
  return reply.type >= firmware::reply_to(MessageType::begin_update) &&
         reply.type <= firmware::reply_to(MessageType::confirm_update);
}

[[noreturn]] void throw_bad_image(const Message& reply) {
  firmware::RefusedImagePayload refused;
  if (!reply.get(refused)) give_up(ExitCode::protocol, "the board refuses the image but does not say why");
  refused.board.back() = '\0';
  give_up(ExitCode::bad_input, fmt::format("the board refuses the image: {}", refusal_text(refused)));
}

/// "axis y: " if the reply names the axis that refuses; otherwise empty.
std::string refusing_axis(const Message& reply) {
  firmware::RefusedAxisPayload refused;
  const bool is_named = reply.type == firmware::reply_to(MessageType::enable) && reply.get(refused) &&
                        refused.axis < firmware::kAxisNames.size();
  return is_named ? fmt::format("axis {}: ", firmware::kAxisNames[refused.axis]) : "";
}

}  // namespace

void require_ok(const Message& reply, const std::string& others) {
  switch (reply.status) {
    case Status::ok:
      return;
    case Status::bad_value:
    case Status::unknown_parameter:
      throw_problem(reply);
    case Status::drive_enabled:
      if (reply.length != 0) throw_problem(reply);
      give_up(ExitCode::refused, "refused while a drive is enabled: `axistool disable` first");
    case Status::wrong_state:
      give_up(ExitCode::refused,
              refusing_axis(reply) +
                  "the axis is not in a state that allows this: `axistool info` shows it; enable it first, and let it "
                  "come to rest");
    case Status::not_standing:
      give_up(ExitCode::refused,
              refusing_axis(reply) +
                  "it moves, or its amplifier still reports ready: wait until it is at rest, then enable it");
    case Status::outside_travel:
      throw_outside_travel(reply);
    case Status::not_fitted:
      give_up(ExitCode::refused,
              refusing_axis(reply) +
                  "the axis is not fitted: give it the parameters of a design (axistool design, axistool set-params)");
    case Status::others_motion:
      give_up(ExitCode::refused,
              "another program moves the axes" + others +
                  ". Or stop them (`axistool disable`), or take the motion over (--take-over of enable, jog, move)");
    case Status::restarting:
      give_up(ExitCode::refused, "the board is about to restart: try again in a second");
    case Status::others_capture:
      give_up(
          ExitCode::refused,
          "another program captures: wait until it has ended (a program that died holds a capture for two seconds)");
    case Status::brown_out_off:
      give_up(ExitCode::refused, brown_out_problem());
    case Status::bad_image:
      throw_bad_image(reply);
    case Status::on_trial:
      give_up(ExitCode::refused,
              "the board runs a new image on trial, and drives stay disabled until it is confirmed: `axistool update` "
              "with the same file confirms it; otherwise the old image returns within a minute");
    case Status::no_probe:
      give_up(ExitCode::refused,
              "no probe is wired: set probe.input to 1 (its input closes on contact) or 2 (it opens) once one is");
    case Status::probe_already:
      give_up(ExitCode::refused,
              "the probe is in contact before the move towards it begins, or not in contact before the one away from "
              "it (G38.4, G38.5): move it, or check its wires and probe.input");
    case Status::not_homed:
      give_up(ExitCode::refused, "the axis is not homed: `axistool home` first (or move it --relative, or jog it)");
    case Status::homing_mode:
      give_up(
          ExitCode::refused,
          "homing.mode selects how to home: with 0 the operator defines it (`axistool home AXIS --here`), otherwise "
          "the axis searches for it (without --here)");
    case Status::unreachable:
      give_up(ExitCode::refused, "the move would last too long: raise limits.velocity, or split it");
    case Status::device_fault:
      give_up(ExitCode::device_fault,
              refusing_axis(reply) + "the board reports a fault: `axistool faults` shows cause and remedy");
    case Status::flash_failed:
      if (is_of_update(reply))
        give_up(ExitCode::device_fault, "the flash rejects the image; the old one stays: try again");
      give_up(ExitCode::device_fault, "the flash rejects the parameters; the former ones remain saved");
    case Status::not_verified:
      if (is_of_update(reply))
        give_up(ExitCode::device_fault, "the image reads back differently; the old one stays: try again");
      give_up(ExitCode::device_fault, "the saved parameters read back differently; the former ones remain saved");
    case Status::wrong_version:
      give_up(ExitCode::protocol,
              "the board speaks another version of the protocol: flash the firmware of this axistool");
    case Status::damaged:
      give_up(ExitCode::protocol, "a report arrived damaged at the board: try again, and another cable or port");
    case Status::set_differs:
      if (is_of_update(reply))
        give_up(ExitCode::protocol,
                "the board got other blocks than were sent: is another program updating it? Try again");
      give_up(ExitCode::protocol,
              "the board staged other values than were sent: is another program setting parameters?");
    case Status::unknown_request:
    case Status::no_room:
    case Status::malformed:
    case Status::no_such_row:
      break;
  }
  give_up(ExitCode::protocol,
          fmt::format("the board does not understand request {:#04x} (status {}): flash the firmware of "
                      "this axistool",
                      static_cast<unsigned>(reply.type) & ~unsigned{firmware::kReplyBit},
                      static_cast<unsigned>(reply.status)));
}

}  // namespace host
