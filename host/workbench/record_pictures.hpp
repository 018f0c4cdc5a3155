// Pictures of the folder's records: the page asks for the visible rows and as many buckets as it has pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/input_limits.hpp"
#include "host/record/record_picture.hpp"
#include "host/workbench/folder.hpp"
#include "host/workbench/request.hpp"

namespace host::workbench {

struct PictureRequest {
  std::string record;
  std::vector<std::string> channels;  ///< empty: the first kMostChannels
  std::uint64_t from = 0, to = 0;     ///< rows [from, to), in sample periods since the first row
  std::size_t pixels = 0;
};

/// { "record", "channels": [...], "from", "to", "pixels" }. Throws Failure(usage) with the field.
PictureRequest parse_picture(std::string_view text);

class RecordPictures {
 public:
  static constexpr std::size_t kMostChannels = 12;
  /// Records in memory at once, and their bytes; the latest one stays even if it is larger.
  static constexpr std::size_t kMost = 8, kMostBytes = 256 * kMebibyte;

  explicit RecordPictures(const Folder& folder) : folder_(folder) {}

  /// The picture of a record as it is in the folder now; begins to read the file unless it is known already. Throws as
  /// Folder::existing() and RecordPicture().
  std::shared_ptr<const RecordPicture> of(const std::string& name);

  /// JSON: { "columns": all channels, "channels": those of the answer, "start_s", "period_s", "end": number of rows,
  /// "share" of the file that has been read, "faulty_rows", "faulty_fields", and the envelope (envelope_text) }. Throws
  /// Failure: as of(), usage for an unknown channel, bad_input if the file cannot be read to its end.
  std::string answer(const PictureRequest& request);

  /// Writes the stretch as a record, as `axistool cut` does, and returns { "pieces": [NAME], "commands": [...] }. Reads
  /// only that part of the file. Throws Failure: as of(), refused while the file is being read, and as cut_record().
  nlohmann::json keep(const CutRequest& request);

 private:
  struct Known {
    std::string name;
    std::shared_ptr<const RecordPicture> picture;
  };

  /// The picture of the file with that stamp, now the latest; null if there is none. Moves one of an older file to
  /// `dropped`. The caller holds the lock.
  std::shared_ptr<const RecordPicture> known_as(const std::string& name, const FileStamp& stamp,
                                                std::list<Known>& dropped);

  const Folder& folder_;
  std::mutex mutex_;
  std::list<Known> known_;  ///< latest first
};

}  // namespace host::workbench
