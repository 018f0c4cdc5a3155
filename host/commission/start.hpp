// How the commissioning of an axis starts or continues: locks the folder, and completes the user's options from it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "host/commission/folder_lock.hpp"
#include "host/commission/session.hpp"

namespace host {

/// What is empty is taken from an earlier run in the folder, if there was one.
struct CommissionWish {
  std::string axis;  ///< x, y, …
  std::string folder;
  std::optional<sim::DriveDescription> sheet;  ///< data sheet of the drive
  std::string box;                             ///< as parse_box() reads it
  std::optional<double> overtravel, force_N;
  bool is_simulated = false;  ///< then there is a usual box
  bool continues = false;     ///< the folder may hold steps
};

struct CommissionStart {
  std::unique_ptr<FolderLock> lock;
  std::unique_ptr<CommissionFolder> folder;
  CommissionOptions options;
};

/// Writes the data sheet and the box into the folder. Throws Failure: usage (no data sheet, or unexpected steps in the
/// folder), refused (no box, or another commissioning uses the folder), permission, bad_input.
CommissionStart start_commission(const CommissionWish& wish);

}  // namespace host
