// Checks that the records describe one machine and that their channels have the same units.
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct Disagreement {
  std::size_t record;  ///< index of the record that disagrees with the others
  std::vector<double> Record::*channel;
  double factor;      ///< ratio of the inertia, or of the tachometer's gain, to that of the other records
  bool friction_too;  ///< friction changes by the same factor, so the command's scale is wrong, not the load
};

/// Compares inertia, friction and tachometer gain of each record in `judged` with those of the other records in `by`.
/// Hidden effects affect the inertia least: on drives with any single effect of the catalogue, records agree about it
/// within 3 %, except for an effect that limits the current, which shows in every record. Returns the record that
/// disagrees most; empty if none does or if the records do not determine it.
std::optional<Disagreement> record_disagreement(const std::vector<const Record*>& by,
                                                const std::vector<const Record*>& judged, const sim::DataSheet& data);

}  // namespace host
