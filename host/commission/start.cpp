#include "host/commission/start.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "hal/axis_count.hpp"
#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/open_board.hpp"

namespace host {

namespace {

sim::DriveDescription sheet_of(const CommissionWish& wish, const std::string& kept) {
  std::error_code fault;
  if (wish.sheet) return *wish.sheet;
  if (std::filesystem::exists(kept, fault)) return read_drive(kept);
  throw Failure(ExitCode::usage,
                "the scales of count, volt and turn are unknown: give this drive's data sheet with --drive DRIVE.toml");
}

/// Default box of a simulated machine.
std::string usual_box(sim::DriveKind kind) {
  return kind == sim::DriveKind::rotary ? "travel=100,speed=200,volts=4,time=360"
                                        : "travel=0.2,speed=0.4,volts=4,time=360";
}

void require_no_steps(const std::string& path, const CommissionFolder& folder) {
  const std::optional<std::size_t> next = folder.first_undone();
  if (next == std::size_t{0}) return;
  throw Failure(ExitCode::usage,
                fmt::format("{} holds a commissioning{}: --from {} continues it, --from look starts "
                            "over, another -o keeps both",
                            path, next ? "" : " that is complete", next ? kCommissionSteps[*next].name : "compensate"));
}

/// The wish, else what the folder holds.
std::optional<double> wished_or_kept(const std::optional<double>& wished, const CommissionFolder& folder,
                                     const char* key) {
  if (wished || !folder.document().contains(key)) return wished;
  return folder.document()[key].get<double>();
}

}  // namespace

CommissionStart start_commission(const CommissionWish& wish) {
  CommissionStart start{std::make_unique<FolderLock>(wish.folder), std::make_unique<CommissionFolder>(wish.folder), {}};
  CommissionFolder& folder = *start.folder;
  if (!wish.continues) require_no_steps(wish.folder, folder);
  CommissionOptions& options = start.options;
  const std::string kept = folder.path("drive.toml");
  options.axis = axis_index(wish.axis, hal::kMostAxes);
  options.axis_name = wish.axis;
  options.sheet = sheet_of(wish, kept);
  options.overtravel = wished_or_kept(wish.overtravel, folder, "overtravel");
  options.force_N = wished_or_kept(wish.force_N, folder, "force_N");
  std::string box = wish.box.empty() ? folder.document().value("box", "") : wish.box;
  if (box.empty() && wish.is_simulated) box = usual_box(options.sheet.data.kind);
  if (box.empty())
    throw Failure(ExitCode::refused,
                  "nothing moves without a box: --box travel=…,speed=…,volts=…,time=…, which the board enforces");
  options.box = parse_box(box, options.sheet.data.kind);
  folder.put("axis", wish.axis);
  folder.put("box", box);
  if (options.overtravel) folder.put("overtravel", *options.overtravel);
  if (options.force_N) folder.put("force_N", *options.force_N);
  write_model(options.sheet, kept);
  return start;
}

}  // namespace host
