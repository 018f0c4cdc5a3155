// Checks that records describe one machine, with all channels in the same units.
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct Disagreement {
  std::size_t record;  ///< the one that disagrees with the others
  std::vector<double> Record::*channel;
  double factor;      ///< ratio of the inertia, or of the tachometer's gain, to that of the other records
  bool friction_too;  ///< friction changes by the same factor: the command's scale is wrong, not the load
};

/// Compares inertia, friction and tachometer gain of each of `judged` with those of the records `by`, except itself.
/// Hidden effects disturb inertia least: on drives with any single effect of the catalogue, records agree about it
/// within 3 %, unless the effect limits the current, which shows in every record. Names the record that disagrees most;
/// empty if none does or the records do not determine it.
std::optional<Disagreement> record_disagreement(const std::vector<const Record*>& by,
                                                const std::vector<const Record*>& judged, const sim::DataSheet& data);

}  // namespace host
