#include "host/workbench/folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <system_error>

#include "host/commission/steps.hpp"
#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"

namespace host::workbench {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 2000, kLongestName = 500;
constexpr int kMostLevels = 4;

bool is_inside(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

/// The beginning of a file, which determines its kind: long enough to contain a model's effects, which follow its data
/// sheet.
std::string head_of(const fs::path& path, std::size_t size = 8192) {
  std::string head(size, 0);
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(size));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

bool is_log(const std::string& extension) {
  constexpr std::array kRead{".csv", ".txt", ".tsv", ".log",  ".dat", ".mat",
                             ".npy", ".npz", ".h5",  ".hdf5", ".db3", ".mcap"};
  return std::ranges::find(kRead, extension) != kRead.end();
}

/// Kind of a file; empty if it is not read here.
std::string kind_of(const fs::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".toml") {
    const std::string head = head_of(path);
    if (head.find("axis-model/1") == std::string::npos) return "";
    return head.find("[[effect]]") == std::string::npos ? "sheet" : "model";
  }
  constexpr std::size_t kResponseSize = 1 << 20;  // the format stands behind lists of numbers
  if (extension == ".json")
    return head_of(path, kResponseSize).find("axis-response/1") == std::string::npos ? "" : "response";
  if (!is_log(extension)) return "";
  if (extension != ".csv") return "log";
  const std::string head = head_of(path);
  return head.find("axis-record/1") != std::string::npos || head.starts_with("t_s,") ? "record" : "log";
}

/// "" if no commissioning recorded it.
std::string role_of(const fs::path& record) {
  std::error_code unreadable;
  if (!fs::exists(record.parent_path() / "commission.json", unreadable)) return "";
  const std::string name = record.filename().string();
  const auto is_among = [&](const std::vector<std::string>& files) {
    return std::ranges::find(files, name) != files.end();
  };
  return is_among(kJudgingFiles) ? "judge" : is_among(kTrainingFiles) || is_planned_run(name) ? "train" : "off";
}

}  // namespace

bool is_plain_name(std::string_view name) {
  if (name.empty() || name.size() > kLongestName || name.front() == '-') return false;
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F || c == '\\'; }))
    return false;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (end == begin || name[begin] == '.') return false;
    begin = end + 1;
  }
  return true;
}

Folder::Folder() : root_(fs::canonical(fs::current_path())) {}

std::vector<FolderFile> Folder::files() const {
  std::vector<FolderFile> found;
  std::error_code unreadable;
  constexpr auto kOptions = fs::directory_options::skip_permission_denied;
  for (auto entry = fs::recursive_directory_iterator(root_, kOptions, unreadable);
       !unreadable && entry != fs::recursive_directory_iterator() && found.size() < kMostFiles;
       entry.increment(unreadable)) {
    const std::string name = entry->path().lexically_relative(root_).string();
    std::error_code gone;
    if (entry->is_directory(gone) && (!is_plain_name(name) || name == kOwnFolder || entry.depth() >= kMostLevels))
      entry.disable_recursion_pending();
    if (!is_plain_name(name) || !entry->is_regular_file(gone)) continue;
    const fs::path real = fs::canonical(entry->path(), gone);
    if (gone || !is_inside(real, root_)) continue;
    std::string kind = kind_of(real);
    if (kind.empty()) continue;
    std::string role = kind == "record" ? role_of(real) : "";
    found.push_back({name, std::move(kind), static_cast<std::size_t>(fs::file_size(real, gone)), std::move(role)});
  }
  std::ranges::sort(found, {}, &FolderFile::name);
  return found;
}

std::string Folder::existing(const std::string& name) const {
  if (!is_plain_name(name))
    throw Failure(ExitCode::usage, fmt::format("\"{}\": expected a name below the folder", name));
  std::error_code missing;
  const fs::path real = fs::canonical(root_ / name, missing);
  if (missing) throw Failure(ExitCode::bad_input, name + ": there is no such file in the folder");
  if (!is_inside(real, root_)) throw Failure(ExitCode::permission, name + ": leads out of the folder");
  if (!fs::is_regular_file(real)) throw Failure(ExitCode::bad_input, name + ": is not a file");
  return name;
}

std::string Folder::free_name(const std::string& stem, const std::string& extension) const {
  std::string name = stem + extension;
  // A dangling link also counts as used, because a writer would follow it.
  for (int k = 2; fs::exists(fs::symlink_status(root_ / name)); ++k) name = fmt::format("{}-{}{}", stem, k, extension);
  return name;
}

std::string Folder::own_file(const std::string& name) const {
  std::error_code failed;
  fs::create_directory(root_ / kOwnFolder, failed);
  const fs::path real = fs::canonical(root_ / kOwnFolder, failed);
  if (failed || !is_inside(real, root_) || fs::is_symlink(real / name, failed))
    throw Failure(ExitCode::permission, fmt::format("{}/{}: leads out of the folder", kOwnFolder, name));
  return fmt::format("{}/{}", kOwnFolder, name);
}

Upload::Upload(const Folder& folder, const std::string& name) : folder_(folder), name_(name) {
  const std::string extension = fs::path(name).extension().string();
  if (!is_plain_name(name) || name.find('/') != std::string::npos || (extension != ".toml" && !is_log(extension)))
    throw Failure(
        ExitCode::usage,
        fmt::format(
            "\"{}\": expected a model (.toml), a record or a log (.csv, .txt, .tsv, .log, .dat, .mat, .npy, .npz, "
            ".h5, .hdf5, .db3, .mcap)",
            name));
  static std::atomic<unsigned> count = 0;
  partial_ = folder.own_file(fmt::format("upload-{}.partial", ++count));
  file_.open(partial_, std::ios::binary | std::ios::trunc);
}

Upload::~Upload() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

bool Upload::append(const char* data, std::size_t size) {
  bytes_ += size;
  if (bytes_ > kLogSize.bytes) return false;
  return static_cast<bool>(file_.write(data, static_cast<std::streamsize>(size)));
}

std::string Upload::finish() {
  file_.close();
  if (!file_) throw Failure(ExitCode::bad_input, name_ + ": could not be written into the folder");
  const fs::path path(name_);
  std::string name = folder_.free_name(path.stem().string(), path.extension().string());
  fs::rename(partial_, name);
  partial_.clear();
  return name;
}

}  // namespace host::workbench
