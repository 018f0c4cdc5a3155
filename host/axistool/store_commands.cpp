// axistool save, backup, restore: parameters in the board's flash and in files.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "firmware/app/store/pitch_check.hpp"
#include "host/atomic_file.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/axistool/json_output.hpp"
#include "host/axistool/parameter_commands.hpp"
#include "host/device/pitch_table.hpp"
#include "host/parameters/backup_file.hpp"
#include "host/read_file.hpp"

namespace axistool {

namespace {

struct StoreArguments : DeviceArguments {
  std::string file;
  bool save = true;
};

void save(const StoreArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  if (!arguments.dry_run) board.save();
  const host::BoardState status = board.status();
  if (!arguments.json.empty())
    write_json({{"format", "axis-save/1"},
                {"saved", !arguments.dry_run},
                {"sequence", status.store_sequence},
                {"erases", status.store_erases}},
               arguments.json);
  if (!talks(arguments)) return;
  if (arguments.dry_run)
    fmt::print("would save; the board {} unsaved changes\n",
               (status.flags & firmware::kBoardUnsaved) != 0 ? "has" : "has no");
  else
    fmt::print("saved as set {}; flash erased {} times of some 20000\n", status.store_sequence, status.store_erases);
}

void backup(const StoreArguments& arguments) {
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const firmware::ParameterValues values = board.read_values();
  std::vector<firmware::StoredEntry> foreign;
  for (const firmware::StoredEntry& entry : board.read_stored()) {
    const auto place = values.place_of({entry.key});
    const bool fits =
        place && firmware::check_value(firmware::rule_at(*place), std::bit_cast<float>(entry.value_bits)) ==
                     firmware::ValueRefusal::none;
    if (!fits) foreign.push_back(entry);
  }
  host::PitchTables pitch;
  for (std::size_t axis = 0; axis < values.axes(); ++axis)
    pitch.push_back(host::read_pitch(board, static_cast<std::uint8_t>(axis)));
  host::write_file_atomically(arguments.file, host::format_backup(values, foreign, pitch));
  if (!arguments.json.empty())
    write_json({{"format", "axis-backup/1"},
                {"file", arguments.file},
                {"parameters", values.size()},
                {"not_in_table", foreign.size()}},
               arguments.json);
  if (!talks(arguments)) return;
  fmt::print("{} parameters written to {}\n", values.size(), arguments.file);
  if (!foreign.empty())
    fmt::print("{} stored values do not fit this firmware's table; the file keeps them as comments\n", foreign.size());
}

/// Sets the values without pitch.on, then the tables, because the board refuses pitch.on without a table and a table in
/// other counts.
void write_whole(host::BoardClient& board, const firmware::ParameterValues& values,
                 const std::optional<host::PitchTables>& pitch) {
  if (!pitch) return board.write_values(values);
  constexpr std::uint16_t kSwitch = firmware::pitch_check::kSwitch;
  firmware::ParameterValues without = values;
  for (std::size_t axis = 0; axis < values.axes(); ++axis)
    without.set(*values.place_of(firmware::ParameterKey::of_axis(axis, kSwitch)), 0.0F);
  board.write_values(without);
  for (std::size_t axis = 0; axis < values.axes(); ++axis) {
    const auto number = static_cast<std::uint8_t>(axis);
    const bool on = values.axis(axis).get<"pitch.on">();
    if (on || (*pitch)[axis] != host::read_pitch(board, number)) host::write_pitch(board, number, (*pitch)[axis], on);
  }
}

void restore(const StoreArguments& arguments) {
  const std::string text = host::read_file(arguments.file);
  const std::vector<host::Assignment> list = host::parse_backup(text, arguments.file);
  host::BoardClient board = open_board(arguments);
  board.require_same_table();
  const firmware::ParameterValues before = board.read_values();
  const std::optional<host::PitchTables> pitch = host::pitch_of_backup(text, arguments.file, before.axes());
  firmware::ParameterValues after(before.axes());
  for (const host::Assignment& one : list) host::put(after, one);
  host::require_fitting_set(after);
  const std::vector<Difference> changes = differences(before, after);
  if (!arguments.dry_run) {
    require_consent(arguments, fmt::format("Replace {} of the board's parameters and save?", changes.size()));
    write_whole(board, after, pitch);
    board.save();
  }
  if (!arguments.json.empty())
    write_json({{"format", "axis-params-change/1"},
                {"changes", differences_json(changes)},
                {"applied", !arguments.dry_run},
                {"saved", !arguments.dry_run}},
               arguments.json);
  if (!talks(arguments)) return;
  print_differences(changes, "was", "is");
  fmt::print("{} parameters {}; all others have their initial values\n", changes.size(),
             arguments.dry_run ? "would change" : "changed and saved");
}

}  // namespace

void add_save(CLI::App& app) {
  auto arguments = std::make_shared<StoreArguments>();
  CLI::App* command = app.add_subcommand("save", "Save a board's parameters to its flash");
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer(
      "Example:\n  axistool save\nRefused (exit code 8) while a drive is enabled. Takes up to 4 s on hardware.");
  command->callback([arguments] { save(*arguments); });
}

void add_backup(CLI::App& app) {
  auto arguments = std::make_shared<StoreArguments>();
  CLI::App* command =
      app.add_subcommand("backup", "Write all parameters and tables of pitch errors of a board to a file");
  add_output(*command, "FILE", arguments->file, "file to write (axis-params/1)")->required();
  add_device_options(*command, *arguments);
  command->footer("Example:\n  axistool backup machine-7.toml");
  command->callback([arguments] { backup(*arguments); });
}

void add_restore(CLI::App& app) {
  auto arguments = std::make_shared<StoreArguments>();
  CLI::App* command =
      app.add_subcommand("restore", "Set a board's parameters and tables to exactly those of a backup, and save them");
  add_input(*command, "FILE", arguments->file, "file written by backup")->required();
  add_device_options(*command, *arguments);
  add_change_options(*command, *arguments);
  command->footer("Example:\n  axistool restore machine-7.toml --yes");
  command->callback([arguments] { restore(*arguments); });
}

}  // namespace axistool
