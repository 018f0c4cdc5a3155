// axistool update: updates a board's firmware over its USB cable.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/device/image_file.hpp"
#include "host/device/image_update.hpp"
#include "host/report/progress.hpp"

namespace axistool {

namespace {

struct UpdateArguments : DeviceArguments {
  std::string file;
};

host::ImageSlotsSeen slots_of(host::BoardClient& board) {
  auto seen = host::read_slots(board);
  if (!seen)
    throw host::Failure(
        host::ExitCode::refused,
        "this board's firmware cannot be updated over its cable: write a firmware that can with `axistool flash`");
  return *seen;
}

bool runs(const host::ImageSlotsSeen& seen, const host::ImageFile& file) {
  return seen.program.crc == file.header.crc && seen.program.size == file.header.image_size;
}

void send(host::BoardClient& board, const host::ImageFile& file) {
  host::Progress progress("update", file.image().size());
  std::size_t shown = 0;
  host::send_image(board, file, [&](std::size_t sent, std::size_t) {
    progress.advance(sent - shown);
    shown = sent;
  });
}

/// Confirms the new image if it runs; throws Failure if the board has returned to the old one.
void confirm(host::BoardClient& board, const host::ImageFile& file) {
  if (!runs(slots_of(board), file))
    throw host::Failure(host::ExitCode::device_fault,
                        fmt::format("the new image did not start, and the board has returned to version {}; "
                                    "`axistool info` shows the contents of its slots",
                                    board.identify().version.data()));
  host::confirm_image(board);
}

void update(const UpdateArguments& arguments) {
  const host::ImageFile file = host::read_image_file(arguments.file);
  host::BoardClient board = open_board(arguments);
  const firmware::IdentityPayload before = board.identify();
  host::check_image_for(file, before.board.data());
  host::ImageSlotsSeen seen = slots_of(board);
  const bool is_there = runs(seen, file);
  if (!is_there && (board.status().flags & (firmware::kBoardYours | firmware::kBoardOthers)) != 0)
    throw host::Failure(host::ExitCode::refused, "refused while a drive is enabled: `axistool disable` first");
  const bool writes = !is_there && !arguments.dry_run;
  if (writes) {
    send(board, file);
    host::BoardClient restarted = host::restart_and_reopen(std::move(board), [&] { return open_board(arguments); });
    confirm(restarted, file);
    seen = slots_of(restarted);
  } else if (is_there && seen.is_on_trial() && !arguments.dry_run) {
    host::confirm_image(board);
    seen = slots_of(board);
  }
  if (!arguments.json.empty())
    write_json({{"format", "axis-update/1"},
                {"file", arguments.file},
                {"board", before.board.data()},
                {"from", before.version.data()},
                {"to", file.header.version.data()},
                {"bytes", file.image().size()},
                {"written", writes},
                {"confirmed", (writes || is_there) && !seen.is_on_trial()},
                {"slots", host::slots_json(seen)}},
               arguments.json);
  if (!talks(arguments)) return;
  const char* const version = file.header.version.data();
  if (is_there)
    fmt::print("{} runs version {} already\n", before.board.data(), version);
  else
    fmt::print("{}: version {}, {} bytes, {} version {}\n", before.board.data(), version, file.image().size(),
               writes ? "runs in place of" : "would replace", before.version.data());
  fmt::print("{}", host::slots_text(seen));
}

}  // namespace

void add_update(CLI::App& app) {
  auto arguments = std::make_shared<UpdateArguments>();
  CLI::App* command = app.add_subcommand("update", "Update a board's firmware over its USB cable");
  add_input(*command, "FILE", arguments->file, "image file (.bin), the same as for flash")->required();
  add_device_options(*command, *arguments);
  command->add_flag("--dry-run", arguments->dry_run, "check image and board, and write nothing");
  command->footer(
      "Examples:\n"
      "  axistool update build/firmware/images/axis-f405.bin --dry-run\n"
      "  axistool update build/firmware/images/axis-f405.bin\n"
      "  axistool sim --write-image next.bin; axistool update next.bin --sim     # the simulated board\n"
      "The board keeps the image that runs and takes the new one beside it, checks it, restarts, and runs it on trial; "
      "this\n"
      "command confirms it. Without that the old image returns: at the next reset, or after 30 s. Parameters, pitch "
      "tables\n"
      "and fault log stay. Exit codes: 5 the transfer failed; 6 the new image did not start, the old one runs; 8 "
      "refused: a\n"
      "drive is enabled, another image is on trial, or the board needs `axistool flash` once; 9 image damaged or for "
      "another\n"
      "board.");
  command->callback([arguments] { update(*arguments); });
}

}  // namespace axistool
