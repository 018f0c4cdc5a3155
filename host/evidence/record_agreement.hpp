// Whether records describe one machine, with its channels in one set of units.
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct Disagreement {
  std::size_t record;  ///< the one that disagrees with the others
  std::vector<double> Record::*channel;
  double factor;      ///< by which inertia, or the tachometer's gain, comes out larger than from the others
  bool friction_too;  ///< friction comes out larger by the same factor: the command's scale, not the load
};

/// Compares what each of `judged` says of inertia and friction, and of the tachometer against the encoder, with what
/// the records of `by` other than itself say. Inertia is what hidden effects disturb least: on drives with any single
/// effect of the catalogue records agree about it within 3 %, unless the effect limits the current, which shows in
/// every record. Names the record that disagrees most; empty where none does or the records cannot tell.
std::optional<Disagreement> record_disagreement(const std::vector<const Record*>& by,
                                                const std::vector<const Record*>& judged, const sim::DataSheet& data);

}  // namespace host
