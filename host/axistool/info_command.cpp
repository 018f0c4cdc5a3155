// axistool info: version and state of a board or a firmware image.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "firmware/app/parameters/parameter_values.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/board_report.hpp"
#include "host/device/image_file.hpp"
#include "host/device/image_update.hpp"
#include "host/device/pitch_table.hpp"

namespace axistool {

namespace {

struct InfoArguments : DeviceArguments {
  std::string image;
};

void describe_image(const InfoArguments& arguments) {
  const host::ImageFile image = host::read_image_file(arguments.image);
  const firmware::ImageHeader& header = image.header;
  const bool whole = image.state == firmware::ImageState::whole;
  if (!whole) end_with(host::ExitCode::answer_is_no);
  if (!arguments.json.empty())
    write_json({{"format", "axis-image/1"},
                {"board", header.board.data()},
                {"version", header.version.data()},
                {"git_hash", header.git_hash.data()},
                {"chip_id", header.chip_id},
                {"schema_hash", header.schema_hash},
                {"size", header.image_size},
                {"crc32", header.crc},
                {"whole", whole}},
               arguments.json);
  if (!talks(arguments)) return;
  fmt::print("board        {}\nversion      {}\ncommit       {}\nchip         {:#05x}\n", header.board.data(),
             header.version.data(), header.git_hash.data(), header.chip_id);
  fmt::print("schema hash  {:#010x}\nsize         {} bytes\nCRC-32       {:#010x}\nimage        {}\n",
             header.schema_hash, header.image_size, header.crc, host::describe(image.state));
}

void describe_board(const InfoArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  const firmware::IdentityPayload identity = board.identify();
  const host::BoardState status = board.status();
  const firmware::TimingPayload timing = board.timing(false);
  std::optional<firmware::ParameterValues> values;
  if (identity.schema_hash == firmware::kSchemaHash) values = board.read_values();
  const firmware::ParameterValues* known = values ? &*values : nullptr;
  std::vector<std::string> tables;  // of pitch errors, one for each axis
  for (std::uint8_t axis = 0; known != nullptr && axis < status.axis.size(); ++axis)
    tables.push_back(
        host::read_pitch_text(board, axis, known->axis(axis).get<"pitch.on">(), host::count_mm_of(*known, axis)));
  const auto slots = host::read_slots(board);
  const unsigned probe = known != nullptr ? board.probe_state().flags : 0;
  const bool has_probe = (probe & firmware::kProbeWired) != 0, touches = (probe & firmware::kProbeTouches) != 0;
  if (!arguments.json.empty()) {
    nlohmann::json document = host::board_json(board.name(), identity, status, timing, known);
    for (std::size_t axis = 0; axis < tables.size(); ++axis) document["axes"][axis]["pitch_table"] = tables[axis];
    if (slots) document["slots"] = host::slots_json(*slots);
    if (has_probe) document["probe_touches"] = touches;
    write_json(document, arguments.json);
  }
  if (!talks(arguments)) return;
  fmt::print("{}", host::board_text(board.name(), identity, status, timing, known));
  if (slots) fmt::print("{}", host::slots_text(*slots));
  if (has_probe) fmt::print("probe        {}\n", touches ? "in contact" : "not in contact");
  for (std::size_t axis = 0; axis < tables.size(); ++axis)
    if (!tables[axis].empty()) fmt::print("pitch {}      {}\n", firmware::kAxisNames[axis], tables[axis]);
}

}  // namespace

void add_info(CLI::App& app) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "Show version and state of a board or of a firmware image");
  command->alias("status");
  add_input(*command, "IMAGE", arguments->image, "image file (.bin); without it, the board");
  add_device_options(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  axistool info\n"
      "  axistool info --sim --json -\n"
      "  axistool info build/firmware/images/axis-f405.bin\n"
      "Exit code 1: the image is damaged.");
  command->callback(
      [arguments] { arguments->image.empty() ? describe_board(*arguments) : describe_image(*arguments); });
}

}  // namespace axistool
