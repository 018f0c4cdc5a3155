#include "host/workbench/record_pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/record/edit_record.hpp"
#include "host/record/read_record.hpp"
#include "host/report/text_format.hpp"
#include "host/workbench/envelope_text.hpp"
#include "host/workbench/request_fields.hpp"

namespace host::workbench {

namespace {

/// Time that a request waits for the file, so that the picture of a short record is complete at once.
constexpr double kPatienceForFile_s = 0.15;

std::uint64_t whole_of(const nlohmann::json& document, const std::string& field) {
  const auto found = document.find(field);
  if (found == document.end() || !found->is_number_unsigned()) refuse(field, "expected a whole number from 0");
  return found->get<std::uint64_t>();
}

/// Places of the wanted channels among the columns.
std::vector<std::size_t> places_of(const PictureRequest& request, const std::vector<std::string>& columns) {
  std::vector<std::size_t> places;
  for (const std::string& name : request.channels) {
    const auto found = std::ranges::find(columns, name);
    if (found == columns.end())
      throw Failure(ExitCode::usage, fmt::format("request, \"channels\": {} has no channel {}; it has {}",
                                                 request.record, name, fmt::join(columns, ", ")));
    places.push_back(static_cast<std::size_t>(found - columns.begin()));
  }
  if (request.channels.empty())
    for (std::size_t k = 0; k < std::min(columns.size(), RecordPictures::kMostChannels); ++k) places.push_back(k);
  return places;
}

}  // namespace

PictureRequest parse_picture(std::string_view text) {
  const nlohmann::json document = object_of(text);
  require_known(document, {"record", "channels", "from", "to", "pixels"});
  PictureRequest request;
  request.record = file_of(text_of(document, "record"), "record");
  request.channels = list_of(document, "channels", [](const std::string& name, const std::string&) { return name; });
  if (request.channels.size() > RecordPictures::kMostChannels)
    refuse("channels", fmt::format("expected at most {}", RecordPictures::kMostChannels));
  request.from = whole_of(document, "from");
  request.to = whole_of(document, "to");
  if (request.to <= request.from) refuse("to", "expected a row after \"from\"");
  request.pixels = whole_of(document, "pixels");
  if (request.pixels == 0 || request.pixels > RecordPicture::kMostPoints)
    refuse("pixels", fmt::format("expected 1 to {}", RecordPicture::kMostPoints));
  return request;
}

std::shared_ptr<const RecordPicture> RecordPictures::known_as(const std::string& name, const FileStamp& stamp,
                                                              std::list<Known>& dropped) {
  const auto found = std::ranges::find(known_, name, &Known::name);
  if (found == known_.end()) return nullptr;
  if (found->picture->file().stamp() == stamp) {
    known_.splice(known_.begin(), known_, found);
    return known_.front().picture;
  }
  dropped.splice(dropped.end(), known_, found);
  return nullptr;
}

std::shared_ptr<const RecordPicture> RecordPictures::of(const std::string& name) {
  const FileStamp now = file_stamp(folder_.existing(name));
  std::list<Known> dropped;  // destroyed after the lock is released, because that waits for the readers
  {
    const std::lock_guard lock(mutex_);
    if (auto known = known_as(name, now, dropped)) return known;
  }
  // Opened without the lock: a slow file does not delay the pictures of others.
  auto opened = std::make_shared<const RecordPicture>(name);
  const std::lock_guard lock(mutex_);
  if (auto known = known_as(name, now, dropped)) return known;  // another request was faster
  known_.push_front({name, std::move(opened)});
  std::size_t bytes = known_.front().picture->bytes(), kept = 1;
  for (auto one = std::next(known_.begin()); one != known_.end();) {
    const auto here = one++;
    bytes += here->picture->bytes();
    if (++kept > kMost || bytes > kMostBytes) dropped.splice(dropped.end(), known_, here);
  }
  return known_.front().picture;
}

std::string RecordPictures::answer(const PictureRequest& request) {
  const std::shared_ptr<const RecordPicture> picture = of(request.record);
  const RecordFile& file = picture->file();
  const std::vector<std::size_t> places = places_of(request, file.columns());
  picture->wait(kPatienceForFile_s);
  const RecordPicture::Progress progress = picture->progress();
  if (!progress.problem.empty()) throw Failure(ExitCode::bad_input, progress.problem);
  Envelope all = picture->envelope(request.from, request.to, request.pixels);
  Envelope chosen{all.first, all.rows, std::move(all.taken), {}, {}};
  nlohmann::json channels = nlohmann::json::array();
  for (const std::size_t place : places) {
    channels.push_back(file.columns()[place]);
    chosen.low.push_back(all.low[place]);
    chosen.high.push_back(all.high[place]);
  }
  const nlohmann::json about = {{"columns", file.columns()},
                                {"channels", std::move(channels)},
                                {"start_s", file.start_s()},
                                {"period_s", file.period_s()},
                                {"end", file.rows()},
                                {"share", progress.share},
                                {"faulty_rows", progress.faults.rows},
                                {"faulty_fields", progress.faults.fields}};
  std::string text = about.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.back() = ',';
  return text + envelope_text(chosen, 0).substr(1);
}

nlohmann::json RecordPictures::keep(const CutRequest& request) {
  const std::shared_ptr<const RecordPicture> picture = of(request.record);
  const RecordFile& file = picture->file();
  const auto row_at = [&](double t_s) {
    return static_cast<std::uint64_t>(
        std::clamp((t_s - file.start_s()) / file.period_s(), 0.0, static_cast<double>(file.rows())));
  };
  const std::uint64_t from = row_at(request.stretch.from_s), to = row_at(request.stretch.to_s) + 2;
  const Record piece = cut_record(picture->text_of(from > 0 ? from - 1 : 0, to), request.record, request.stretch.from_s,
                                  request.stretch.to_s);
  const std::string stem = std::filesystem::path(request.record).replace_extension().string();
  const std::string name =
      folder_.free_name(fmt::format("{}-{:.6g}-{:.6g}s", stem, request.stretch.from_s, request.stretch.to_s), ".csv");
  write_record(piece, name);
  return {{"pieces", {name}},
          {"commands",
           {fmt::format("axistool cut {} --from {} --to {} -o {}", shell_word(request.record), request.stretch.from_s,
                        request.stretch.to_s, shell_word(name))}}};
}

}  // namespace host::workbench
