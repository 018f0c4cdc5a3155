// Any body of a request to the workbench is accepted or refused; accepted requests name only files in the folder.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/workbench/folder.hpp"
#include "host/workbench/live_request.hpp"
#include "host/workbench/loop.hpp"
#include "host/workbench/request.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  using namespace host::workbench;
  try {
    const Request request = parse_request(text);
    for (const auto* names : {&request.models, &request.train, &request.validate})
      for (const std::string& name : *names)
        if (!is_plain_name(name)) std::abort();
    if (to_json(parse_request(to_json(request).dump())) != to_json(request)) std::abort();
    if (command_line(request, {"m.toml", "d.json", "r.html"}).find('\0') != std::string::npos) std::abort();
  } catch (const host::Failure&) {
  }
  try {
    if (!is_plain_name(parse_cut(text).record)) std::abort();
  } catch (const host::Failure&) {
  }
  try {
    for (const std::string& name : parse_open(text).logs)
      if (!is_plain_name(name)) std::abort();
  } catch (const host::Failure&) {
  }
  try {
    const nlohmann::json choice = parse_choice(text);
    if (parse_choice(choice.dump()) != choice) std::abort();
  } catch (const host::Failure&) {
  }
  const auto is_parsed = [&](auto parse) {
    try {
      parse(text);
    } catch (const host::Failure&) {
    }
  };
  is_parsed(parse_owner);
  is_parsed(parse_channels);
  is_parsed(parse_trigger_wish);
  is_parsed(parse_rows);
  is_parsed(parse_parameter_file);
  try {
    for (const std::string& one : parse_parameters(text).assignments)
      if (one.find('\n') != std::string::npos) std::abort();
  } catch (const host::Failure&) {
  }
  try {
    const LoopRequest loop = parse_loop(text);
    if (!is_plain_name(loop.model) || loop_command(loop, "p.toml").find('\n') != std::string::npos) std::abort();
  } catch (const host::Failure&) {
  }
  try {
    const MotionRequest motion = parse_motion(text);
    if (!std::isfinite(motion.velocity)) std::abort();
  } catch (const host::Failure&) {
  }
  return 0;
}
